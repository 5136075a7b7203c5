#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace heliograph::scene {

/// The names of the document's scenes, empty where one has none.
std::vector<std::string> read_scene_names(const tinygltf::Model& model);

/// The scene with name or index `requested`; the document's default when `requested` is empty.
/// Nullopt when the document has no scenes. @throws NoSuchChoice, ImportError
std::optional<std::uint32_t> choose_scene(const tinygltf::Model& model,
                                          const std::string& requested);

/// The index of `requested` among the names of variants; nullopt when `requested` is empty.
/// @throws NoSuchChoice
std::optional<std::uint32_t> choose_variant(const std::vector<std::string>& variants,
                                            const std::string& requested);

}  // namespace heliograph::scene
