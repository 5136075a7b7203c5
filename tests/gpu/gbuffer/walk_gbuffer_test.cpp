#include "render/passes/gbuffer/walk_gbuffer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <glm/ext/matrix_transform.hpp>
#include <string>
#include <utility>
#include <vector>

#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/section/section_tracer.hpp"
#include "scene/gltf/materials/materials.hpp"
#include "scene/import.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"
#include "tests/gpu/support/layered_scene.hpp"
#include "tests/gpu/support/textured_scene.hpp"

namespace heliograph::test {
namespace {

/// The G-buffer of one view in rounds and by walk_gbuffer. A tracer that cuts rays, by no planes
/// here, is one whose structures no other shader can walk: it keeps to the rounds on every device.
class RoundsAndWalk {
 public:
  RoundsAndWalk(std::shared_ptr<const scene::Scene> scene, const scene::Camera& camera,
                VkExtent2D extent)
      : rig_(std::move(scene), camera, {.extent = extent, .tracer = "software"}),
        uncut_(rig_.inputs().tracer, rig_.inputs().programs, rig_.moving().section()) {
    const render::FrameInputs& in = with_host_kernels(rig_, false);
    const auto hierarchy = in.tracer.walked(in.structure);
    EXPECT_TRUE(hierarchy.has_value());
    rounds_ = render::trace_gbuffer(rig_.plan(), with_tracer(in, uncut_));
    if (hierarchy) walked_ = render::walk_gbuffer(rig_.plan(), in, *hierarchy);
  }

  FrameRig& rig() { return rig_; }

  void expect_equal(const std::string& which) const {
    using render::GBuffer;
    expect_same_gbuffer(rig_, rounds_, walked_, which);
    // Texels so coarse that no compiler's contraction of a sum shows in more than a few.
    const std::pair<const char*, gpu::ImageRef GBuffer::*> images[] = {
        {"base color", &GBuffer::base_color},
        {"surface", &GBuffer::surface},
        {"instance", &GBuffer::instance}};
    for (const auto& [name, image] : images) {
      EXPECT_LE(differing_texels(image, false), 2e-3) << which << ": " << name;
    }
  }
  void expect_equal_layers(const std::string& which) const {
    EXPECT_LE(differing_texels(&render::GBuffer::layers, true), 2e-3) << which;
  }
  /// instance + 1
  float shown_in_middle() const {
    const render::FloatImage instance = rig_.read(walked_.instance);
    return texel(instance, instance.width / 2, instance.height / 2).x;
  }

  /// Of pixels, those that show something.
  double covered() const {
    const render::FloatImage instance = rig_.read(walked_.instance);
    int shown = 0;
    for (std::size_t i = 0; i < instance.rgba.size(); i += 4) shown += instance.rgba[i] > 0.0f;
    return shown / (double{1} * instance.width * instance.height);
  }

  /// Whether camera rays were drawn.
  bool draws() const {
    return std::ranges::any_of(rig_.plan().timings(), [](const gpu::PassTiming& timing) {
      return timing.name == "gbuffer.beside";
    });
  }

  /// How many rays went on behind the first surface.
  std::uint64_t passed() const {
    for (const gpu::PassWork& work : rig_.plan().work()) {
      if (work.name == "gbuffer.passed") return work.entries;
    }
    return 0;
  }

 private:
  /// The part of all texels, or of those that show something, whose bytes differ.
  double differing_texels(gpu::ImageRef render::GBuffer::*image, bool of_shown) const {
    const auto bytes = [&](gpu::ImageRef of) { return rig_.plan().latest(of).download(); };
    const auto expected = bytes(rounds_.*image), actual = bytes(walked_.*image);
    const render::FloatImage instance = rig_.read(walked_.instance);
    const std::size_t texels = std::size_t{instance.width} * instance.height;
    const std::size_t size = expected.size() / texels;
    std::size_t compared = 0, differing = 0;
    for (std::size_t i = 0; i < texels; ++i) {
      if (of_shown && instance.rgba[4 * i] == 0.0f) continue;
      ++compared;
      differing += std::memcmp(&expected[i * size], &actual[i * size], size) != 0;
    }
    EXPECT_GT(compared, 0u);
    return static_cast<double>(differing) / static_cast<double>(compared);
  }

  mutable FrameRig rig_;
  render::SectionTracer uncut_;
  render::GBuffer rounds_, walked_;
};

scene::Camera moved_a_little(scene::Camera camera) {
  camera.eye += glm::vec3(0.05f, -0.02f, 0.03f);
  return camera;
}

scene::Camera fitted_camera(const scene::Scene& scene, bool orthographic) {
  scene::Camera camera = scene::fit_camera(scene.bounds, 40.0f, 1.5f);
  if (orthographic) camera.orthographic_height = 2.2f * scene.bounds.radius();
  return camera;
}

/// So many panes with their backs to the camera, in front of a wall.
std::shared_ptr<const scene::Scene> panes_seen_from_behind(int panes) {
  SceneBuilder builder;
  const auto pane = builder.add_quad({{{1, -1, 0}, {-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}}},
                                     surface({0.9f, 0.1f, 0.1f}));
  for (int i = 0; i < panes; ++i) {
    builder.place(pane, glm::translate(glm::mat4(1.0f), {0, 0, 0.25f * static_cast<float>(i)}));
  }
  builder.place(builder.add_quad({{{-3, -3, -1}, {3, -3, -1}, {3, 3, -1}, {-3, 3, -1}}},
                                 surface({0.2f, 0.6f, 0.9f})));
  return builder.build();
}

TEST(WalkGBuffer, FindsWhatRoundsFind) {
  for (const bool orthographic : {false, true}) {
    for (const auto& [name, scene] :
         {std::pair("textured", textured_scene()), std::pair("transparent", transparent_scene())}) {
      const scene::Camera camera = fitted_camera(*scene, orthographic);
      RoundsAndWalk both(scene, camera, {150, 100});
      both.rig().set_view(moved_a_little(camera), 3);
      both.rig().run();
      both.expect_equal(std::string(name) + (orthographic ? ", orthographic" : ", perspective"));
      EXPECT_GT(both.covered(), 0.1) << name;
    }
  }
}

TEST(WalkGBuffer, FindsLayersThatRoundsFind) {
  for (const float alpha : {1.0f, 0.5f}) {
    const LayeredCase layered{.layers = brushed_film, .alpha = alpha};
    RoundsAndWalk both(layered_scene(layered), layered_camera(layered), {120, 80});
    both.rig().run();
    both.expect_equal("alpha " + std::to_string(alpha));
    both.expect_equal_layers("alpha " + std::to_string(alpha));
    EXPECT_EQ(both.passed() > 100, alpha < 1.0f);
  }
}

TEST(WalkGBuffer, TakesLastSurfaceAsRoundsDo) {
  const scene::Camera camera = look({0, 0, 5}, {0, 0, 0}, 30.0f);
  for (const int panes : {2, 3, 4, 6}) {
    RoundsAndWalk both(panes_seen_from_behind(panes), camera, {64, 64});
    both.rig().run();
    both.expect_equal(std::to_string(panes) + " panes");
    EXPECT_GT(both.passed(), 500u);
    // The fourth surface is a pane's back, or else the wall shows.
    EXPECT_EQ(both.shown_in_middle(), static_cast<float>(panes < 4 ? panes + 1 : panes - 3));
  }
}

TEST(WalkGBuffer, GoesOnThroughAllBlendedSurfaces) {
  SceneBuilder builder;
  shared::Material glass = surface({0.2f, 0.8f, 0.3f});
  glass.base_color.w = 0.3f;
  glass.flags = shared::material_alpha_blend;
  const auto pane = builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, glass);
  for (int i = 0; i < 9; ++i) {
    builder.place(pane, glm::translate(glm::mat4(1.0f), {0, 0, 0.1f * static_cast<float>(i)}));
  }
  RoundsAndWalk both(builder.build(), look({0, 0, 5}, {0, 0, 0}, 30.0f), {64, 64});
  both.rig().run();
  both.expect_equal("nine panes");
  EXPECT_EQ(both.shown_in_middle(), 2.0f) << "the eighth surface from the front";
}

TEST(WalkGBuffer, WorksAtAnySize) {
  const auto scene = transparent_scene();
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    RoundsAndWalk both(scene, fitted_camera(*scene, false), extent);
    both.rig().run();
    both.expect_equal(std::to_string(extent.width) + " x " + std::to_string(extent.height));
  }
}

TEST(WalkGBuffer, DrawsManyTriangles) {
  SceneBuilder builder;
  const auto sphere = builder.add_sphere(0.6f, surface({0.2f, 0.8f, 0.3f}));
  for (int i = 0; i < 12; ++i) {
    builder.place(sphere, glm::translate(glm::mat4(1.0f), {i % 4 - 1.5f, i / 4 - 1, -0.3f * i}));
  }
  const auto scene = builder.build();
  RoundsAndWalk both(scene, fitted_camera(*scene, false), {210, 140});
  both.rig().set_view(moved_a_little(fitted_camera(*scene, false)), 3);
  both.rig().run();
  both.expect_equal("spheres");
  EXPECT_GT(both.covered(), 0.1);
  EXPECT_EQ(both.draws(), device().atomics_64());
}

/// Spheres, every other one mirrored, and one around the eye at the origin: all of its faces are
/// seen from behind.
std::shared_ptr<const scene::Scene> spheres_around_the_eye(bool mirrored) {
  SceneBuilder builder;
  const auto sphere = builder.add_sphere(1.0f, surface({0.2f, 0.8f, 0.3f}));
  const glm::vec3 straight(0.5f), turned(-0.5f, 0.5f, 0.5f);
  builder.place(sphere, glm::scale(glm::mat4(1.0f), mirrored ? turned : straight));
  for (int i = 0; i < 6; ++i) {
    const glm::vec3 at(static_cast<float>(i % 3) - 1.0f, static_cast<float>(i / 3) - 0.5f, -4.0f);
    builder.place(sphere,
                  glm::scale(glm::translate(glm::mat4(1.0f), at), i % 2 == 0 ? straight : turned));
  }
  return builder.build();
}

TEST(WalkGBuffer, DrawsNoBacksOfOneSidedTriangles) {
  for (const bool orthographic : {false, true}) {
    for (const bool mirrored : {false, true}) {
      scene::Camera camera = look({0, 0, 0}, {0.1f, 0, -1}, 45.0f);
      if (orthographic) camera.orthographic_height = 3.0f;
      RoundsAndWalk both(spheres_around_the_eye(mirrored), camera, {210, 140});
      both.rig().set_view(camera, 3);
      both.rig().run();
      both.expect_equal(std::string(mirrored ? "mirrored" : "not mirrored") +
                        (orthographic ? ", orthographic" : ", perspective"));
      EXPECT_GT(both.covered(), 0.2);
      if (both.draws()) {
        EXPECT_EQ(both.passed() > 0, mirrored);
      }
    }
  }
}

// Unlike in rounds, whose fourth surface is stored.
TEST(WalkGBuffer, DrawsNoBacksHoweverManyThereAre) {
  constexpr int panes = 60;
  RoundsAndWalk both(panes_seen_from_behind(panes), look({0, 0, 40}, {0, 0, 0}, 5.0f), {64, 64});
  both.rig().run();
  if (!both.draws()) GTEST_SKIP() << "camera rays are not drawn";
  EXPECT_EQ(both.shown_in_middle(), static_cast<float>(panes + 1)) << "the wall";
  EXPECT_EQ(both.passed(), 0u);
}

/// The scene with a clip that moves the instances of one mesh.
std::shared_ptr<const scene::Scene> with_moving_mesh(const scene::Scene& scene,
                                                     std::uint32_t mesh) {
  auto copy = std::make_shared<scene::Scene>(scene);
  scene::Clip& clip = copy->clips.emplace_back();
  for (const scene::Instance& instance : copy->instances) {
    if (instance.mesh == mesh) clip.channels.push_back({.node = instance.node});
  }
  return copy;
}

// They are traced beside what is drawn, and rays go on through their backs at once.
TEST(WalkGBuffer, PassesBacksOfWhatMoves) {
  SceneBuilder builder;
  const auto pane = builder.add_quad({{{1, -1, 0}, {-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}}},
                                     surface({0.9f, 0.1f, 0.1f}));
  for (const float z : {0.5f, 1.0f}) {
    builder.place(pane, glm::translate(glm::mat4(1.0f), {0, 0, z}));
  }
  builder.place(builder.add_sphere(1.5f, surface({0.2f, 0.6f, 0.9f})),
                glm::translate(glm::mat4(1.0f), {0, 0, -2}));
  RoundsAndWalk both(with_moving_mesh(*builder.build(), pane), look({0, 0, 5}, {0, 0, 0}, 30.0f),
                     {64, 64});
  both.rig().run();
  both.expect_equal("two panes");
  EXPECT_EQ(both.shown_in_middle(), 3.0f) << "the sphere";
  if (both.draws()) {
    EXPECT_EQ(both.passed(), 0u);
  }
}

// Too near to their plane for the triangle alone to tell which side the camera sees.
TEST(WalkGBuffer, DrawsNoBacksThatAreNearlyEdgeOn) {
  constexpr float below = 0.015f;
  SceneBuilder builder;
  builder.place(
      builder.add_quad({{{-1, -below, 1}, {-1, -below, -1}, {1, -below, -1}, {1, -below, 1}}},
                       surface({0.9f, 0.1f, 0.1f})));
  builder.place(builder.add_sphere(3.0f, surface({0.2f, 0.6f, 0.9f})),
                glm::translate(glm::mat4(1.0f), {0, 0, -6}));
  const auto scene = builder.build();
  for (const bool shows_back : {true, false}) {
    const float side = shows_back ? 1.0f : -1.0f;
    RoundsAndWalk both(scene, look({0, (side - 1.0f) * below, 5}, {0, -below, 0}, 0.5f), {64, 64});
    both.rig().run();
    both.expect_equal(shows_back ? "back" : "front");
    EXPECT_EQ(both.shown_in_middle(), shows_back ? 2.0f : 1.0f);
    if (both.draws()) {
      EXPECT_EQ(both.passed(), 0u);
    }
  }
}

/// A checkered mask with linear filters in front of a sphere.
std::shared_ptr<const scene::Scene> filtered_mask() {
  SceneBuilder builder;
  std::vector<std::uint8_t> checkers;
  for (int i = 0; i < 64; ++i) {
    const std::uint8_t alpha = (i + i / 8) % 2 == 0 ? 255 : 0;
    checkers.insert(checkers.end(), {200, 100, 50, alpha});
  }
  shared::Material masked = surface({0.9f, 0.4f, 0.2f});
  masked.base_color_texture.texture = builder.add_texture(8, 8, true, checkers);
  masked.flags = shared::material_alpha_mask;
  masked.alpha_cutoff = 0.8f;
  builder.place(builder.add_quad({{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}}, masked));
  builder.place(builder.add_sphere(1.0f, surface({0.2f, 0.6f, 0.9f})));
  scene::Scene scene = *builder.build();
  scene::Sampler& sampler = scene.textures.at(masked.base_color_texture.texture).sampler;
  sampler.magnify = sampler.minify = scene::Filter::linear;
  scene::build_alpha_heap(scene);
  return std::make_shared<const scene::Scene>(std::move(scene));
}

// Where the nearest texel of a mask covers, the filtered one may not.
TEST(WalkGBuffer, DrawsNoHolesOfFilteredMasks) {
  RoundsAndWalk both(filtered_mask(), look({0, 0, 5}, {0, 0, 0}, 30.0f), {240, 160});
  both.rig().run();
  both.expect_equal("a mask");
  if (!both.draws()) GTEST_SKIP() << "camera rays are not drawn";
  EXPECT_EQ(both.passed(), 0u);
}

TEST(WalkGBuffer, FollowsAnimatedMeshes) {
  const char* assets = std::getenv("HELIOGRAPH_TEST_ASSETS");
  if (!assets) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  const auto folder = std::filesystem::path(assets) / "gltf";
  for (const char* file : {"Fox.glb", "BoxAnimated.glb", "AnimatedMorphCube.glb"}) {
    const auto scene = std::make_shared<const scene::Scene>(scene::import_gltf(folder / file));
    RoundsAndWalk both(scene, fitted_camera(*scene, false), {90, 60});
    for (const double seconds : {0.1, 0.3}) {
      both.rig().moving().set_pose(&scene->clips.at(0), seconds);
      both.rig().moving().advance();
      both.rig().set_view(moved_a_little(fitted_camera(*scene, false)));
      both.rig().run();
      both.expect_equal(std::string(file) + " at " + std::to_string(seconds));
    }
    EXPECT_GT(both.covered(), 0.02) << file;
  }
}

std::vector<std::string> passes_of(const protocol::Settings& settings,
                                   const render::Section& section) {
  FrameRig rig(transparent_scene(), look({0, 0, 5}, {0, 0, 0}),
               {.settings = settings, .tracer = "software"});
  rig.moving().set_section(section);
  render::trace_gbuffer(rig.plan(), with_host_kernels(rig, false));
  rig.run();
  std::vector<std::string> names;
  for (const gpu::PassTiming& timing : rig.plan().timings()) names.push_back(timing.name);
  return names;
}

TEST(WalkGBuffer, ReplacesRoundsOnGpusThatNeedNoHits) {
  const auto walks = [](const std::vector<std::string>& names) {
    const bool passed = std::ranges::count(names, "gbuffer.passed") == 1;
    EXPECT_EQ(std::ranges::count(names, "gbuffer.rays"), passed ? 0 : 1);
    EXPECT_EQ(std::ranges::count(names, "gbuffer.2.trace"), passed ? 0 : 1);
    EXPECT_EQ(std::ranges::count(names, "gbuffer.trace"), 1);
    return passed;
  };
  EXPECT_EQ(walks(passes_of(without_indirect(), {})), !device().is_cpu());
  protocol::Settings clay = without_indirect();
  clay.view.shading = protocol::ShadingMode::clay;
  EXPECT_FALSE(walks(passes_of(clay, {})));
  EXPECT_FALSE(walks(passes_of(without_indirect(), {.planes = {{0, 0, 1, 0.6f}}})));
}

}  // namespace
}  // namespace heliograph::test
