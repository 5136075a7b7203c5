#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/json/json_values.hpp"
#include "protocol/json/raw_json.hpp"
#include "protocol/json/suggestions.hpp"
#include "protocol/methods.hpp"

// Messages to JSON and back, and the codecs of methods and notifications. Expensive to compile:
// included only where they are instantiated, in methods/*_codec.cpp.

namespace heliograph::protocol {
namespace codec {

using nlohmann::json;

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;
template <class T>
inline constexpr bool is_change = false;
template <class T>
inline constexpr bool is_change<Change<T>> = true;
template <class T>
inline constexpr bool is_list = false;
template <class T>
inline constexpr bool is_list<std::vector<T>> = true;
template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t count>
inline constexpr bool is_array<std::array<T, count>> = true;
template <class T>
concept Integer = std::integral<T> && !std::same_as<T, bool>;

/// The field's range, cut to what the number's type and JSON hold exactly.
template <class T>
NumberRange range_of(const FieldLimits& limits) {
  if constexpr (std::floating_point<T>) {
    constexpr double most = std::numeric_limits<T>::max();
    return {std::max(limits.minimum, -most), std::min(limits.maximum, most)};
  } else {
    constexpr double exact = 9007199254740991.0;
    const auto lowest = static_cast<double>(std::numeric_limits<T>::lowest());
    const auto highest = static_cast<double>(std::numeric_limits<T>::max());
    return {std::max({limits.minimum, lowest, -exact}), std::min({limits.maximum, highest, exact})};
  }
}

template <class T>
Result<void> read(const json& in, T& out, const std::string& path, const FieldLimits& limits);

template <class T>
Result<void> keep(Result<T> value, auto& out) {
  if (!value) return std::move(value).error();
  out = static_cast<std::remove_reference_t<decltype(out)>>(*std::move(value));
  return {};
}

inline Result<void> check_length(std::size_t length, const std::string& path,
                                 const FieldLimits& limits, const char* what) {
  if (length >= limits.min_length && length <= limits.max_length) return {};
  NumberRange range{static_cast<double>(limits.min_length), static_cast<double>(limits.max_length)};
  if (limits.max_length == unlimited_length) {
    range.maximum = std::numeric_limits<double>::infinity();
  }
  return error::invalid(path, std::string("has the wrong number of ") + what, range_text(range));
}

inline Result<void> read_string(const json& in, std::string& out, const std::string& path,
                                const FieldLimits& limits) {
  const Result<void> kept = keep(read_text(in, path), out);
  if (!kept) return kept;
  return check_length(out.size(), path, limits, "characters");
}

template <class List>
Result<void> read_elements(const json& in, List& out, const std::string& path,
                           const FieldLimits& limits) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Result<void> element = read(in[i], out[i], path + "[" + std::to_string(i) + "]", limits);
    if (!element) return element;
  }
  return {};
}

template <class List>
Result<void> read_list(const json& in, List& out, const std::string& path,
                       const FieldLimits& limits) {
  if (!in.is_array()) return error::invalid(path, "must be a list");
  const Result<void> length = check_length(in.size(), path, limits, "elements");
  if (!length) return length;
  out.clear();
  out.resize(in.size());
  FieldLimits of_element = limits;
  of_element.min_length = 0;
  of_element.max_length = unlimited_length;
  return read_elements(in, out, path, of_element);
}

template <class Array>
Result<void> read_array(const json& in, Array& out, const std::string& path,
                        const FieldLimits& limits) {
  const std::string count = std::to_string(out.size());
  if (!in.is_array() || in.size() != out.size()) {
    return error::invalid(path, "must be a list of " + count + " elements");
  }
  return read_elements(in, out, path, limits);
}

template <class Owner, class Member>
Result<void> read_field(const json& in, Owner& out, const Field<Owner, Member>& field,
                        const std::string& prefix) {
  const auto found = in.find(std::string(field.name));
  constexpr bool takes_null = std::is_same_v<Member, RawJson> || is_change<Member>;
  const bool absent = found == in.end() || (found->is_null() && !takes_null);
  const std::string path =
      prefix.empty() ? std::string(field.name) : prefix + "." + std::string(field.name);
  if (!absent) return read(*found, out.*field.member, path, field.limits);
  constexpr bool may_lack = is_optional<Member> || is_change<Member>;
  if (may_lack || field.presence == Presence::defaulted) return {};
  return error::invalid(path, "is required");
}

template <Message T>
std::vector<std::string_view> member_names() {
  return std::apply(
      [](const auto&... fields) { return std::vector<std::string_view>{fields.name...}; },
      T::fields());
}

template <StrictMessage T>
Result<void> check_members(const json& in, const std::string& path) {
  const std::vector<std::string_view> names = member_names<T>();
  for (const auto& [name, value] : in.items()) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    return error::invalid(path.empty() ? name : path + "." + name,
                          "is not a member" + suggestion(name, names), choices_text(names));
  }
  return {};
}

/// Members of an object that are not among `names`, one sentence each; the first few of them.
inline std::vector<std::string> unknown_names(const json& in,
                                              const std::vector<std::string_view>& names) {
  constexpr std::size_t most = 8;
  std::vector<std::string> unknown;
  for (const auto& [name, value] : in.items()) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    if (unknown.size() == most) break;
    unknown.push_back(name + ": is not a parameter" + suggestion(name, names));
  }
  return unknown;
}

template <Message T>
Result<void> read_message(const json& in, T& out, const std::string& path) {
  if (!in.is_object()) {
    return error::invalid(path.empty() ? "params" : path, "must be an object");
  }
  if constexpr (StrictMessage<T>) {
    if (const Result<void> known = check_members<T>(in, path); !known) return known;
  }
  Result<void> outcome;
  std::apply(
      [&](const auto&... fields) {
        // Stops at the first member that is refused.
        (void)(... && (outcome = read_field(in, out, fields, path)).has_value());
      },
      T::fields());
  return outcome;
}

template <class T>
Result<void> read(const json& in, T& out, const std::string& path, const FieldLimits& limits) {
  if constexpr (std::is_same_v<T, bool>) {
    return keep(read_boolean(in, path), out);
  } else if constexpr (Integer<T>) {
    return keep(read_integer(in, path, range_of<T>(limits)), out);
  } else if constexpr (std::floating_point<T>) {
    return keep(read_number(in, path, range_of<T>(limits)), out);
  } else if constexpr (std::is_enum_v<T>) {
    return keep(read_choice(in, path, enum_names<T>()), out);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return read_string(in, out, path, limits);
  } else if constexpr (std::is_same_v<T, RawJson>) {
    out = RawJson(in);
    return {};
  } else if constexpr (is_optional<T>) {
    return read(in, out.emplace(), path, limits);
  } else if constexpr (is_change<T>) {
    out.reset = in.is_null();
    return out.reset ? Result<void>() : read(in, out.value.emplace(), path, limits);
  } else if constexpr (is_list<T>) {
    return read_list(in, out, path, limits);
  } else if constexpr (is_array<T>) {
    return read_array(in, out, path, limits);
  } else {
    return read_message(in, out, path);
  }
}

template <class T>
json write(const T& value) {
  if constexpr (std::is_same_v<T, float>) {
    return shortest(value);
  } else if constexpr (std::is_enum_v<T>) {
    return enum_name(value);
  } else if constexpr (std::is_same_v<T, RawJson>) {
    return value.value();
  } else if constexpr (is_optional<T>) {
    return value ? write(*value) : json();
  } else if constexpr (is_change<T>) {
    return write(value.value);
  } else if constexpr (is_list<T> || is_array<T>) {
    json list = json::array();
    for (const auto& element : value) list.push_back(write(element));
    return list;
  } else if constexpr (Message<T>) {
    json object = json::object();
    const auto write_field = [&](const auto& field) {
      json member = write(value.*field.member);
      using Member = std::remove_cvref_t<decltype(value.*field.member)>;
      if (is_optional<Member> && member.is_null() && field.presence != Presence::or_null) return;
      if constexpr (is_change<Member>) {
        const Member& change = value.*field.member;
        if (!change.value && !change.reset) return;
      }
      object[std::string(field.name)] = std::move(member);
    };
    std::apply([&](const auto&... fields) { (write_field(fields), ...); }, T::fields());
    return object;
  } else {
    return value;
  }
}

inline void put_range(json& schema, const NumberRange& range, bool integer) {
  const auto put = [&](const char* key, double bound) {
    if (!std::isfinite(bound)) return;
    if (integer) {
      schema[key] = static_cast<std::int64_t>(bound);
    } else {
      schema[key] = bound;
    }
  };
  put("minimum", range.minimum);
  put("maximum", range.maximum);
}

inline void put_length(json& schema, const FieldLimits& limits, const char* least,
                       const char* most) {
  if (limits.min_length > 0) schema[least] = limits.min_length;
  if (limits.max_length != unlimited_length) {
    schema[most] = limits.max_length;
  }
}

template <class T>
json schema(const FieldLimits& limits);

template <Message T>
json message_schema() {
  json properties = json::object();
  json required = json::array();
  const T initial;
  const auto add = [&](const auto& field) {
    using Member = std::remove_cvref_t<decltype(initial.*field.member)>;
    json entry = schema<Member>(field.limits);
    entry["description"] = field.help;
    if (!field.unit_name.empty()) entry["x-unit"] = field.unit_name;
    const bool optional =
        is_change<Member> || (is_optional<Member> && field.presence != Presence::or_null);
    if (field.presence == Presence::or_null || is_change<Member>)
      entry["type"] = {entry["type"], "null"};
    if (field.presence == Presence::defaulted) {
      entry["default"] = write(initial.*field.member);
    } else if (!optional) {
      required.push_back(field.name);
    }
    properties[std::string(field.name)] = std::move(entry);
  };
  std::apply([&](const auto&... fields) { (add(fields), ...); }, T::fields());
  json object{{"type", "object"}, {"properties", std::move(properties)}};
  if constexpr (StrictMessage<T>) object["additionalProperties"] = false;
  if (!required.empty()) object["required"] = std::move(required);
  return object;
}

template <class T>
json schema(const FieldLimits& limits) {
  if constexpr (std::is_same_v<T, bool>) {
    return {{"type", "boolean"}};
  } else if constexpr (Integer<T>) {
    json result{{"type", "integer"}};
    put_range(result, range_of<T>(limits), true);
    return result;
  } else if constexpr (std::floating_point<T>) {
    json result{{"type", "number"}};
    put_range(result, {limits.minimum, limits.maximum}, false);
    return result;
  } else if constexpr (std::is_enum_v<T>) {
    return {{"type", "string"}, {"enum", enum_names<T>()}};
  } else if constexpr (std::is_same_v<T, std::string>) {
    json result{{"type", "string"}};
    put_length(result, limits, "minLength", "maxLength");
    return result;
  } else if constexpr (std::is_same_v<T, RawJson>) {
    return {{"type", "object"}};
  } else if constexpr (is_optional<T>) {
    return schema<typename T::value_type>(limits);
  } else if constexpr (is_change<T>) {
    return schema<typename decltype(T::value)::value_type>(limits);
  } else if constexpr (is_list<T>) {
    json items = schema<typename T::value_type>({});
    if constexpr (is_optional<typename T::value_type>) items["type"] = {items["type"], "null"};
    json result{{"type", "array"}, {"items", std::move(items)}};
    put_length(result, limits, "minItems", "maxItems");
    return result;
  } else if constexpr (is_array<T>) {
    const std::size_t count = std::tuple_size_v<T>;
    return {{"type", "array"},
            {"items", schema<typename T::value_type>(limits)},
            {"minItems", count},
            {"maxItems", count}};
  } else {
    return message_schema<T>();
  }
}

}  // namespace codec

/// Reads a message. Unknown members are ignored; a missing, ill-typed or out-of-range member gives
/// ErrorCode::invalid_params with its path ("cameras[2].eye"), the reason and the limit.
template <class T>
Result<T> decode(const RawJson& json) {
  T message;
  const Result<void> outcome = codec::read(json.value(), message, "", FieldLimits{});
  if (!outcome) return outcome.error();
  return message;
}

template <class T>
RawJson encode(const T& message) {
  return RawJson(codec::write(message));
}

/// JSON Schema 2020-12 of a message.
template <class T>
RawJson schema_of() {
  return RawJson(codec::schema<T>(FieldLimits{}));
}

template <class Method>
Result<typename Method::Params> MethodCodec<Method>::read_params(const RawJson& json) {
  return decode<typename Method::Params>(json);
}

template <class Method>
std::vector<std::string> MethodCodec<Method>::unknown_params(const RawJson& json) {
  return codec::unknown_names(json.value(), codec::member_names<typename Method::Params>());
}

template <class Method>
RawJson MethodCodec<Method>::write_result(const typename Method::Result& result) {
  return encode(result);
}

template <class Method>
Result<void> MethodCodec<Method>::check_params(const RawJson& json) {
  const auto params = decode<typename Method::Params>(json);
  if (!params) return params.error();
  return {};
}

template <class Method>
Result<void> MethodCodec<Method>::check_result(const RawJson& json) {
  const auto result = decode<typename Method::Result>(json);
  if (!result) return result.error();
  return {};
}

template <class Method>
RawJson MethodCodec<Method>::params_schema() {
  return schema_of<typename Method::Params>();
}

template <class Method>
RawJson MethodCodec<Method>::result_schema() {
  return schema_of<typename Method::Result>();
}

template <class Notification>
RawJson NotificationCodec<Notification>::write_params(const typename Notification::Params& params) {
  return encode(params);
}

template <class Notification>
RawJson NotificationCodec<Notification>::params_schema() {
  return schema_of<typename Notification::Params>();
}

}  // namespace heliograph::protocol
