#include "scene/gltf/document/extension_value.hpp"

namespace heliograph::scene {
namespace {

std::vector<std::uint32_t> index_items(const tinygltf::Value& list) {
  std::vector<std::uint32_t> result;
  for (std::size_t i = 0; i < list.ArrayLen(); ++i) {
    result.push_back(static_cast<std::uint32_t>(list.Get(static_cast<int>(i)).GetNumberAsInt()));
  }
  return result;
}

}  // namespace

std::optional<ExtensionValue> ExtensionValue::object(const std::string& member) const {
  if (!has(member)) return std::nullopt;
  return ExtensionValue(value_->Get(member), path_ + "." + member);
}

std::vector<ExtensionValue> ExtensionValue::objects(const std::string& member) const {
  std::vector<ExtensionValue> result;
  const tinygltf::Value& list = value_->Get(member);
  for (std::size_t i = 0; i < list.ArrayLen(); ++i) {
    result.emplace_back(list.Get(static_cast<int>(i)), item_path(path_, member, i));
  }
  return result;
}

std::string ExtensionValue::text(const std::string& member) const {
  return has(member) ? value_->Get(member).Get<std::string>() : std::string();
}

bool ExtensionValue::boolean(const std::string& member, bool fallback) const {
  return has(member) ? value_->Get(member).Get<bool>() : fallback;
}

std::optional<float> ExtensionValue::number(const std::string& member) const {
  if (!has(member)) return std::nullopt;
  return static_cast<float>(value_->Get(member).GetNumberAsDouble());
}

std::optional<std::uint64_t> ExtensionValue::integer(const std::string& member) const {
  if (!has(member)) return std::nullopt;
  return static_cast<std::uint64_t>(value_->Get(member).GetNumberAsDouble());
}

std::optional<std::uint32_t> ExtensionValue::index(const std::string& member) const {
  if (!has(member)) return std::nullopt;
  return static_cast<std::uint32_t>(value_->Get(member).GetNumberAsInt());
}

std::vector<std::uint32_t> ExtensionValue::indices(const std::string& member) const {
  return index_items(value_->Get(member));
}

std::vector<std::uint32_t> ExtensionValue::index_list(const std::string& member,
                                                      std::size_t list) const {
  return index_items(value_->Get(member).Get(static_cast<int>(list)));
}

std::optional<ExtensionValue> find_extension(const tinygltf::ExtensionMap& extensions,
                                             const std::string& name, const std::string& path) {
  const auto found = extensions.find(name);
  if (found == extensions.end()) return std::nullopt;
  return ExtensionValue(found->second, path + ".extensions." + name);
}

}  // namespace heliograph::scene
