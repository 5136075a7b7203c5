#include "scene/gltf/document/json_value.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

using nlohmann::json;

// Some exporters write integers as 3.0: accepted as integers.
std::optional<std::uint64_t> as_integer(const json& value) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (!value.is_number_float()) return std::nullopt;
  const double number = value.get<double>();
  if (!(number >= 0.0 && number <= 9007199254740992.0) || number != std::floor(number)) {
    return std::nullopt;
  }
  return static_cast<std::uint64_t>(number);
}

std::optional<float> as_number(const json& value) {
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  if (!(std::abs(number) <= std::numeric_limits<float>::max())) return std::nullopt;
  return static_cast<float>(number);
}

std::string index_reason(std::uint64_t index, std::size_t count, std::string_view plural) {
  return std::to_string(index) + " is not an index into " + std::to_string(count) + " " +
         std::string(plural);
}

void check_shape(std::string_view text, std::uint32_t max_depth, std::uint64_t max_values) {
  std::uint32_t depth = 0;
  std::uint64_t values = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') {
        ++i;
      } else if (c == '"') {
        in_string = false;
      }
      continue;
    }
    if (c == '"') in_string = true;
    if (c == ',' || c == '[' || c == '{') ++values;
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (depth > max_depth) {
      throw ImportError("JSON nests deeper than " + std::to_string(max_depth) + " levels");
    }
    if (values > max_values) {
      throw ImportError("JSON has more than " + std::to_string(max_values) + " values");
    }
  }
}

}  // namespace

void JsonValue::refuse(std::string_view reason) const {
  throw ImportError((path_.empty() ? "document" : path_) + ": " + std::string(reason));
}

void JsonValue::refuse(std::string_view key, std::string_view reason) const {
  throw ImportError(path_to(key) + ": " + std::string(reason));
}

std::string JsonValue::path_to(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

const json* JsonValue::find(std::string_view key) const {
  if (!json_->is_object()) refuse("must be an object");
  const auto found = json_->find(std::string(key));
  return found == json_->end() ? nullptr : &*found;
}

bool JsonValue::has(std::string_view key) const {
  return find(key) != nullptr;
}

bool JsonValue::is_object(std::string_view key) const {
  const json* found = find(key);
  return found && found->is_object();
}

std::optional<JsonValue> JsonValue::object(std::string_view key) const {
  const json* found = find(key);
  if (!found) return std::nullopt;
  if (!found->is_object()) refuse(key, "must be an object");
  return JsonValue(*found, path_to(key));
}

std::optional<JsonValue> JsonValue::object(std::string_view key, std::string_view inner_key) const {
  const auto outer = object(key);
  return outer ? outer->object(inner_key) : std::nullopt;
}

std::vector<JsonValue> JsonValue::objects(std::string_view key) const {
  std::vector<JsonValue> result;
  const json* found = find(key);
  if (!found) return result;
  if (!found->is_array()) refuse(key, "must be an array");
  result.reserve(found->size());
  for (std::size_t i = 0; i < found->size(); ++i) {
    result.emplace_back((*found)[i], path_to(key) + "[" + std::to_string(i) + "]");
    if (!(*found)[i].is_object()) result.back().refuse("must be an object");
  }
  return result;
}

std::vector<std::string> JsonValue::keys() const {
  std::vector<std::string> result;
  if (!json_->is_object()) refuse("must be an object");
  for (const auto& item : json_->items()) result.push_back(item.key());
  return result;
}

std::string JsonValue::text(std::string_view key) const {
  const json* found = find(key);
  if (!found) return {};
  if (!found->is_string()) refuse(key, "must be a string");
  return found->get<std::string>();
}

std::vector<std::string> JsonValue::texts(std::string_view key) const {
  std::vector<std::string> result;
  const json* found = find(key);
  if (!found) return result;
  if (!found->is_array()) refuse(key, "must be an array");
  for (const json& item : *found) {
    if (!item.is_string()) refuse(key, "must contain strings only");
    result.push_back(item.get<std::string>());
  }
  return result;
}

bool JsonValue::boolean(std::string_view key, bool fallback) const {
  const json* found = find(key);
  if (!found) return fallback;
  if (!found->is_boolean()) refuse(key, "must be true or false");
  return found->get<bool>();
}

std::optional<float> JsonValue::number(std::string_view key) const {
  const json* found = find(key);
  if (!found) return std::nullopt;
  const auto value = as_number(*found);
  if (!value) refuse(key, "must be a number that fits 32 bits");
  return value;
}

std::optional<std::vector<float>> JsonValue::numbers(std::string_view key,
                                                     std::size_t count) const {
  const json* found = find(key);
  if (!found) return std::nullopt;
  const std::string reason = "must be an array of " + std::to_string(count) + " numbers";
  if (!found->is_array() || found->size() != count) refuse(key, reason);
  std::vector<float> result;
  for (const json& item : *found) {
    const auto value = as_number(item);
    if (!value) refuse(key, reason);
    result.push_back(*value);
  }
  return result;
}

std::optional<std::uint64_t> JsonValue::integer(std::string_view key) const {
  const json* found = find(key);
  if (!found) return std::nullopt;
  const auto value = as_integer(*found);
  if (!value) refuse(key, "must be a whole number, zero or more");
  return value;
}

std::uint64_t JsonValue::required_integer(std::string_view key) const {
  const auto value = integer(key);
  if (!value) refuse(key, "is missing");
  return *value;
}

std::optional<std::uint32_t> JsonValue::index(std::string_view key, std::size_t count,
                                              std::string_view plural) const {
  const auto value = integer(key);
  if (!value) return std::nullopt;
  if (*value >= count) refuse(key, index_reason(*value, count, plural));
  return static_cast<std::uint32_t>(*value);
}

std::uint32_t JsonValue::required_index(std::string_view key, std::size_t count,
                                        std::string_view plural) const {
  const auto value = index(key, count, plural);
  if (!value) refuse(key, "is missing");
  return *value;
}

std::vector<std::uint32_t> JsonValue::indices(std::string_view key, std::size_t count,
                                              std::string_view plural) const {
  std::vector<std::uint32_t> result;
  const json* found = find(key);
  if (!found) return result;
  if (!found->is_array()) refuse(key, "must be an array");
  result.reserve(found->size());
  for (const json& item : *found) {
    const auto value = as_integer(item);
    if (!value) refuse(key, "must contain whole numbers, zero or more");
    if (*value >= count) refuse(key, index_reason(*value, count, plural));
    result.push_back(static_cast<std::uint32_t>(*value));
  }
  return result;
}

json parse_json(std::string_view text, std::uint32_t max_depth, std::uint64_t max_values) {
  check_shape(text, max_depth, max_values);
  try {
    json document = json::parse(text);
    if (!document.is_object()) throw ImportError("not a glTF file: the JSON is not an object");
    return document;
  } catch (const json::parse_error& error) {
    throw ImportError("not a glTF file: JSON syntax error at byte " + std::to_string(error.byte));
  } catch (const json::exception&) {
    throw ImportError("JSON holds a number that does not fit");
  }
}

}  // namespace heliograph::scene
