#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/json/suggestions.hpp"
#include "protocol/result.hpp"
#include "scene/unique_names.hpp"

// What the edits of lights and of materials have in common.

namespace heliograph::session {

using scene::UniqueNames;

/// Names of the members of `now` that are not as in `initial`.
template <class Info>
std::vector<std::string> differences(const Info& now, const Info& initial) {
  std::vector<std::string> names;
  const auto compare = [&](const auto& field) {
    if (field.name != "changed" && now.*field.member != initial.*field.member) {
      names.emplace_back(field.name);
    }
  };
  std::apply([&](const auto&... fields) { (compare(fields), ...); }, Info::fields());
  return names;
}

template <class T, class Member>
void apply_change(const protocol::Change<T>& change, Member& member, const Member& initial) {
  if (change.reset) member = initial;
  if (change.value) member = *change.value;
}

inline protocol::Error no_such_part(const char* kind, const std::string& name,
                                    const std::vector<std::string_view>& names) {
  return protocol::error::not_found(
      kind, std::string("the scene has no such ") + kind + protocol::suggestion(name, names));
}

/// The same error, of a member that lies below `prefix` in the request.
inline protocol::Error below(const protocol::Error& error, const std::string& prefix) {
  return protocol::error::make(error.code, prefix + "." + error.path, error.reason, error.limit);
}

}  // namespace heliograph::session
