#pragma once

#include "tests/support/scene_builder.hpp"

/// Surfaces with everything that extensions of materials add, for tests that compare host kernels
/// with their shaders.
namespace heliograph::test {

scene::MaterialLayers coat(SceneBuilder& builder);
scene::MaterialLayers sheen(SceneBuilder& builder);
scene::MaterialLayers specular(SceneBuilder& builder);
scene::MaterialLayers film(SceneBuilder& builder);
scene::MaterialLayers brushed(SceneBuilder& builder);
/// A textured film on a textured grain, under a coat and sheen.
scene::MaterialLayers brushed_film(SceneBuilder& builder);
scene::MaterialLayers transmission(SceneBuilder& builder);
/// Light that is scattered to the other side.
scene::MaterialLayers diffuse_transmission(SceneBuilder& builder);
/// The same with textures, in a volume, on a grain and under a coat and sheen.
scene::MaterialLayers textured_diffuse_transmission(SceneBuilder& builder);
/// With a texture in every slot but that of the transmission, which keeps to its own surface.
scene::MaterialLayers all_of_them(SceneBuilder& builder);

struct LayeredCase {
  scene::MaterialLayers (*layers)(SceneBuilder&) = nullptr;
  bool areas = false;
  float alpha = 1.0f;
  bool orthographic = false;
  bool unoccluded = false;  // every ray finds what it looks for
  bool shines = false;      // the panel is an emissive light
  float scale = 1.0f;       // of the spheres' instances; their meshes are as much smaller
};

/// Two layered spheres and a panel on a plain floor, lit by punctual lights, or by areas, one of
/// which reaches below the horizon of the floor.
std::shared_ptr<const scene::Scene> layered_scene(const LayeredCase& which);
scene::Camera layered_camera(const LayeredCase& which);
/// Another colour from every side.
scene::Environment colored_environment();

}  // namespace heliograph::test
