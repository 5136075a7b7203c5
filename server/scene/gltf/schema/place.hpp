#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "scene/import_error.hpp"

namespace heliograph::scene {

/// "meshes[2]", or "meshes[2].primitives[0]" with an owner: how errors name an object of a
/// document.
inline std::string item_path(std::string_view owner, std::string_view array, std::size_t index) {
  std::string path(owner);
  if (!path.empty()) path += '.';
  path += array;
  return path + '[' + std::to_string(index) + ']';
}

[[noreturn]] inline void refuse_at(const std::string& path, std::string_view reason) {
  throw ImportError((path.empty() ? "document" : path) + ": " + std::string(reason));
}

[[noreturn]] inline void refuse_at(const std::string& path, std::string_view member,
                                   std::string_view reason) {
  refuse_at(path.empty() ? std::string(member) : path + "." + std::string(member), reason);
}

/// Where a value stands in a document, as a list from the inside out: costs nothing until an error
/// needs its text.
struct Place {
  const Place* owner = nullptr;
  std::string_view member;
  std::optional<std::size_t> index = std::nullopt;

  std::string text() const {
    const std::string outer = owner ? owner->text() : "";
    if (index) return item_path(outer, member, *index);
    return outer.empty() ? std::string(member) : outer + "." + std::string(member);
  }
};

}  // namespace heliograph::scene
