#pragma once

#include <tiny_gltf.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/schema/place.hpp"

namespace heliograph::scene {

/// An object of an extension, or of "extras", that tinygltf leaves as a value, with its place for
/// errors. The document's check has established types and ranges: an absent member yields its
/// default, and that is the only question here.
class ExtensionValue {
 public:
  ExtensionValue(const tinygltf::Value& value, std::string path)
      : value_(&value), path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  [[noreturn]] void refuse(std::string_view reason) const { refuse_at(path_, reason); }
  [[noreturn]] void refuse(std::string_view member, std::string_view reason) const {
    refuse_at(path_, member, reason);
  }

  bool has(const std::string& member) const { return value_->Has(member); }
  std::optional<ExtensionValue> object(const std::string& member) const;
  std::vector<ExtensionValue> objects(const std::string& member) const;
  std::vector<std::string> members() const { return value_->Keys(); }

  std::string text(const std::string& member) const;
  bool boolean(const std::string& member, bool fallback) const;
  std::optional<float> number(const std::string& member) const;
  float number(const std::string& member, float fallback) const {
    return number(member).value_or(fallback);
  }
  template <std::size_t count>
  std::array<float, count> numbers(const std::string& member,
                                   const std::array<float, count>& fallback) const {
    if (!has(member)) return fallback;
    std::array<float, count> result;
    for (std::size_t i = 0; i < count; ++i) {
      result[i] = static_cast<float>(value_->Get(member).Get(int(i)).GetNumberAsDouble());
    }
    return result;
  }
  std::optional<std::uint64_t> integer(const std::string& member) const;
  std::optional<std::uint32_t> index(const std::string& member) const;
  std::vector<std::uint32_t> indices(const std::string& member) const;
  /// One of the lists of an array of them.
  std::vector<std::uint32_t> index_list(const std::string& member, std::size_t list) const;

 private:
  const tinygltf::Value* value_;
  std::string path_;
};

/// The extension of an object at `path`, if it has it.
std::optional<ExtensionValue> find_extension(const tinygltf::ExtensionMap& extensions,
                                             const std::string& name, const std::string& path);

/// tinygltf's index, which is -1 where the document has none.
inline std::optional<std::uint32_t> to_index(int index) {
  if (index < 0) return std::nullopt;
  return static_cast<std::uint32_t>(index);
}

}  // namespace heliograph::scene
