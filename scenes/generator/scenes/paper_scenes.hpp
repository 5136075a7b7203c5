#pragma once

#include <array>
#include <string_view>

#include "scenes/generator/gltf/document.hpp"
#include "scenes/generator/sky/sky.hpp"
#include "scenes/generator/sky/sunlight.hpp"

namespace heliograph::scenes {

/// One of the eight test scenes of Granja and Pereira, "Hybrid-Rendering Techniques in GPU" (2021).
/// The paper gives their names and triangle counts; everything else is ours.
struct PaperScene {
  std::string_view name;  // of the document and, with .glb and .hdr, of its files
  Sun sun;
  float daylight;  // factor on sun and sky: as a camera's aperture, set for what is in view
  Document (*make)(const PaperScene& scene, const ClearSky& sky);

  /// The sky that belongs to its sun.
  ClearSky make_sky(int width, int height) const;
  Document make_document(const ClearSky& sky) const { return make(*this, sky); }
};

/// In the order of the paper's tables.
const std::array<PaperScene, 8>& paper_scenes();

/// @throws std::invalid_argument
const PaperScene& find_paper_scene(std::string_view name);

// What stands behind `make`, each in the file of its name.
Document make_cubes_distance(const PaperScene& scene, const ClearSky& sky);
Document make_icosphere_scene(const PaperScene& scene, const ClearSky& sky);
Document make_shadow_objects(const PaperScene& scene, const ClearSky& sky);
Document make_pillars(const PaperScene& scene, const ClearSky& sky);
Document make_breakfast_room(const PaperScene& scene, const ClearSky& sky);

}  // namespace heliograph::scenes
