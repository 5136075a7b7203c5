#include "scene/gltf/document/scene_choice.hpp"

#include <algorithm>
#include <charconv>

#include "scene/import_error.hpp"
#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

std::optional<std::uint32_t> index_of(const std::vector<std::string>& names,
                                      const std::string& requested) {
  const auto found = std::find(names.begin(), names.end(), requested);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - names.begin());
}

std::optional<std::uint32_t> number_below(std::size_t count, const std::string& text) {
  std::uint32_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || number >= count) return std::nullopt;
  return number;
}

}  // namespace

NoSuchChoice::NoSuchChoice(std::string member, const std::string& requested,
                           std::vector<std::string> names)
    : ImportError("the file has no " + member + " " + in_quotes(requested)),
      member_(std::move(member)),
      names_(std::move(names)) {}

std::vector<std::string> read_scene_names(const tinygltf::Model& model) {
  std::vector<std::string> names;
  for (const tinygltf::Scene& scene : model.scenes) names.push_back(scene.name);
  return names;
}

std::optional<std::uint32_t> choose_scene(const tinygltf::Model& model,
                                          const std::string& requested) {
  const std::vector<std::string> names = read_scene_names(model);
  if (!requested.empty()) {
    auto chosen = index_of(names, requested);
    if (!chosen) chosen = number_below(names.size(), requested);
    if (!chosen) throw NoSuchChoice("scene", requested, names);
    return chosen;
  }
  if (names.empty()) return std::nullopt;
  return static_cast<std::uint32_t>(std::max(model.defaultScene, 0));
}

std::optional<std::uint32_t> choose_variant(const std::vector<std::string>& variants,
                                            const std::string& requested) {
  if (requested.empty()) return std::nullopt;
  const auto chosen = index_of(variants, requested);
  if (!chosen) throw NoSuchChoice("variant", requested, variants);
  return chosen;
}

}  // namespace heliograph::scene
