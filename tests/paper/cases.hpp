#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/settings/settings.hpp"
#include "scenes/generator/gltf/document.hpp"

// The parameters of the paper's section 4: scene, one swept value, movement and technique.
namespace heliograph::paper {

enum class Movement { still, moving_camera, moving_objects_light };
std::string_view name(Movement movement);
/// @throws std::invalid_argument
Movement parse_movement(std::string_view name);

/// The swept value: roughness in scenes of reflections, angular diameter of the sun (degrees) in
/// scenes of shadows.
enum class Swept { roughness, angle };
std::string_view name(Swept swept);
/// The swept value of a scene of the paper. @throws std::invalid_argument
Swept swept_in(std::string_view scene);
/// The values of the paper's figures.
std::span<const float> paper_values(Swept swept);
scenes::Sweep sweep_to(Swept swept, float value);

/// Which light a row shows: that of the paper, which has no indirect diffuse light, or all that the
/// preset has.
enum class Paths { of_paper, all };

/// A row of the tables: a preset, or the preset `separable` with another rectification.
struct Technique {
  std::string name;
  /// Without accumulation, so that the denoised frame is measured even in a static view.
  protocol::Settings settings(Paths paths = Paths::of_paper) const;
};
/// The six presets, then `fast_history`, `percentile` and `gradient`.
const std::vector<Technique>& techniques();
/// @throws std::invalid_argument
const Technique& find_technique(std::string_view name);

}  // namespace heliograph::paper
