// History validity of whole frames, from the reprojection image of the denoisers (xy: previous
// position in pixels, z: mask of valid taps, w: 1 where disoccluded).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

constexpr float wall_distance = 4.0f;

/// A wall that faces the camera and fills the frame.
std::shared_ptr<const scene::Scene> wall() {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-90, -90, 0}, {90, -90, 0}, {90, 90, 0}, {-90, 90, 0}}},
                                 surface({0.6f, 0.5f, 0.4f}, 0.5f)));
  return builder.build();
}

std::shared_ptr<const scene::Scene> ball() {
  SceneBuilder builder;
  builder.place(builder.add_sphere(1.0f, surface({0.6f, 0.5f, 0.4f}, 0.3f)));
  return builder.build();
}

scene::Camera before_wall(float x, float distance = wall_distance, float fov = 45.0f) {
  return look({x, 0, distance}, {x, 0, 0}, fov);
}

struct JitterRig : RendererRig {
  JitterRig(std::shared_ptr<const scene::Scene> scene, const scene::Camera& camera, bool jitter,
            std::uint32_t width = 96, std::uint32_t height = 54)
      : RendererRig(std::move(scene), scene::constant_environment(glm::vec3(1.0f)), camera, width,
                    height) {
    protocol::Settings settings;
    settings.antialiasing.jitter = jitter;
    settings.accumulation.max_samples = 4096;
    apply(settings);
  }
  void show(const scene::Camera& camera) {
    renderer.set_camera(camera);
    renderer.render();
  }
};

/// Pixels per metre on the wall.
float pixels_per_metre(std::uint32_t height, float fov = 45.0f) {
  const float half = wall_distance * std::tan(glm::radians(0.5f * fov));
  return static_cast<float>(height) / (2.0f * half);
}

// Jitter moves samples, but must not move the previous position of a static surface.
TEST(History, StaticViewMapsPixelToItselfDespiteJitter) {
  for (const bool jitter : {false, true}) {
    JitterRig rig(wall(), before_wall(0.3f), jitter);
    rig.renderer.render();
    for (int i = 0; i < 4; ++i) {
      rig.renderer.render();
      const render::FloatImage map = rig.capture("reproject.motion");
      for (std::uint32_t y = 0; y < map.height; ++y) {
        for (std::uint32_t x = 0; x < map.width; ++x) {
          const float* found = &map.rgba[(std::size_t{y} * map.width + x) * 4];
          ASSERT_EQ(found[0], static_cast<float>(x) + 0.5f) << "jitter " << jitter;
          ASSERT_EQ(found[1], static_cast<float>(y) + 0.5f);
          ASSERT_EQ(found[3], 0.0f) << x << " " << y;
        }
      }
    }
  }
}

// Normals that lost precision in the history would differ from the current ones.
TEST(History, NormalsAreBitExactInHistory) {
  JitterRig rig(ball(), look({0.4f, 0.3f, 3}, {0, 0, 0}), false);
  rig.renderer.render();
  const render::FloatImage first = rig.capture("gbuffer.normals");
  rig.renderer.render();
  EXPECT_EQ(first.rgba, rig.capture("gbuffer.normals").rgba);
  const render::FloatImage map = rig.capture("reproject.motion");
  for (std::size_t i = 3; i < map.rgba.size(); i += 4) ASSERT_EQ(map.rgba[i], 0.0f) << i / 4;
}

// 16-bit motion vectors round this motion to zero, and the history drifts.
TEST(History, ResolvesMotionOfHundredthOfPixel) {
  const std::uint32_t width = 1919, height = 8;
  const float fov = 0.5f;
  JitterRig rig(wall(), before_wall(0.0f, wall_distance, fov), false, width, height);
  rig.renderer.render();
  rig.show(before_wall(0.01f / pixels_per_metre(height, fov), wall_distance, fov));
  const render::FloatImage motion = rig.capture("gbuffer.motion");
  for (std::size_t i = 0; i < motion.rgba.size(); i += 4) {
    ASSERT_NEAR(motion.rgba[i] * static_cast<float>(width), 0.01f, 1e-3f) << i / 4;
    ASSERT_NEAR(motion.rgba[i + 1] * static_cast<float>(height), 0.0f, 1e-3f) << i / 4;
  }
}

TEST(History, DisoccludedColumnsHaveNoHistory) {
  for (const float columns : {-3.7f, 3.7f}) {
    JitterRig rig(wall(), before_wall(0.0f), true);
    const float step = columns / pixels_per_metre(54);
    float x = 0.0f;
    for (int i = 0; i < 6; ++i) rig.show(before_wall(x += step));
    const render::FloatImage map = rig.capture("reproject.motion");
    const render::FloatImage history = rig.capture("visibility.history_length");
    for (std::uint32_t row = 0; row < map.height; ++row) {
      for (std::uint32_t column = 0; column < map.width; ++column) {
        const std::size_t at = (std::size_t{row} * map.width + column) * 4;
        const float was = static_cast<float>(column) + columns;
        // Beyond the 3x3 texels that are searched for the surface.
        const bool outside = was < -1.6f || was > static_cast<float>(map.width) + 0.6f;
        const bool within = was >= 0.0f && was <= static_cast<float>(map.width) - 1.0f;
        if (outside) {
          ASSERT_EQ(map.rgba[at + 3], 1.0f) << column << ", moved by " << columns;
          ASSERT_EQ(history.rgba[at], 1.0f) << column;
        }
        if (within) {
          ASSERT_EQ(map.rgba[at + 3], 0.0f) << column << ", moved by " << columns;
          ASSERT_GT(history.rgba[at], 1.0f) << column;
        }
      }
    }
  }
}

// Depth compared without its motion would reject every pixel of an approaching wall.
TEST(History, IsValidWhileCameraApproaches) {
  JitterRig rig(wall(), before_wall(0.0f), true);
  for (int i = 0; i < 6; ++i) {
    rig.show(before_wall(0.0f, wall_distance - 0.25f * static_cast<float>(i)));
  }
  const render::FloatImage map = rig.capture("reproject.motion");
  for (std::size_t i = 3; i < map.rgba.size(); i += 4) ASSERT_EQ(map.rgba[i], 0.0f) << i / 4;
}

// The history does not contain what a lighting switch changes, so it must be reset.
TEST(History, LightingSwitchesResetHistory) {
  using Change = void (*)(protocol::Settings&);
  const std::vector<std::pair<const char*, Change>> switches{
      {"shadows.enabled", [](auto& s) { s.shadows.enabled = false; }},
      {"ambient.occlusion", [](auto& s) { s.ambient.occlusion = false; }},
      {"lighting.direct", [](auto& s) { s.lighting.direct = false; }},
      {"lighting.environment_diffuse", [](auto& s) { s.lighting.environment_diffuse = false; }},
      {"lighting.environment_specular", [](auto& s) { s.lighting.environment_specular = false; }},
      {"lighting.emissive", [](auto& s) { s.lighting.emissive = false; }},
      {"specular.hit_shading",
       [](auto& s) { s.specular.hit_shading = protocol::HitShading::environment; }},
      {"environment.separate_sun", [](auto& s) { s.environment.separate_sun = false; }}};
  for (const auto& [name, change] : switches) {
    JitterRig rig(ball(), look({0.4f, 0.3f, 3}, {0, 0, 0}), true);
    protocol::Settings settings;
    settings.indirect.enabled = false;
    rig.apply(settings);
    for (int i = 0; i < 4; ++i) rig.renderer.render();
    change(settings);
    rig.apply(settings);
    rig.renderer.render();
    for (const char* signal : {"visibility.history_length", "specular.history_length"}) {
      const render::FloatImage history = rig.capture(signal);
      for (std::size_t i = 0; i < history.rgba.size(); i += 4) {
        ASSERT_LE(history.rgba[i], 1.0f) << signal << " after " << name;
      }
    }
  }
}

// No silent fallback: exactly the requested tracer and passes run.
TEST(EffectivePipeline, MatchesRequestedTracerAndPasses) {
  for (const auto& [tracer, kind, pass] :
       {std::tuple{"embree", protocol::TracerKind::embree, protocol::PassKind::host},
        {"software", protocol::TracerKind::software, protocol::PassKind::device}}) {
    if (!is_supported(tracer)) continue;
    EXPECT_EQ(engine(tracer).tracer(), kind);
    RendererRig rig(ball(), scene::constant_environment(glm::vec3(1.0f)),
                    look({0.4f, 0.3f, 3}, {0, 0, 0}), 32, 18, tracer);
    for (const auto source :
         {protocol::PrimaryVisibility::raster, protocol::PrimaryVisibility::rays}) {
      for (const bool denoised : {false, true}) {
        protocol::Settings settings;
        settings.gbuffer.source = source;
        settings.shadow_temporal.enabled = settings.shadow_blur.enabled = denoised;
        settings.specular_temporal.enabled = settings.specular_blur.enabled = denoised;
        rig.apply(settings);
        const render::Frame frame = rig.renderer.render();
        const auto passes = [&](const std::string& name) {
          return std::count_if(frame.passes.begin(), frame.passes.end(),
                               [&](const auto& p) { return p.name == name; });
        };
        for (const char* trace : {"shadows.trace", "ambient.trace", "specular.trace"}) {
          ASSERT_EQ(passes(trace), 1) << trace << " by " << tracer;
          for (const render::PassTime& time : frame.passes) {
            if (time.name != trace) continue;
            EXPECT_EQ(time.kind, pass) << trace << " by " << tracer;
          }
        }
        EXPECT_EQ(passes("gbuffer.trace") > 0, source == protocol::PrimaryVisibility::rays);
        EXPECT_EQ(passes("gbuffer") + passes("gbuffer.draw") > 0,
                  source == protocol::PrimaryVisibility::raster);
        EXPECT_EQ(passes("visibility.temporal") > 0, denoised);
        EXPECT_EQ(passes("specular.temporal") > 0, denoised);
      }
    }
  }
}

/// The shortest history of the frame.
float shortest_history(RendererRig& rig) {
  const render::FloatImage lengths = rig.capture("visibility.history_length");
  float shortest = lengths.rgba[0];
  for (std::size_t i = 0; i < lengths.rgba.size(); i += 4) {
    shortest = std::min(shortest, lengths.rgba[i]);
  }
  return shortest;
}

// Otherwise one animated material makes the whole image as noisy as a first frame.
TEST(History, StaysWhereAClipAnimatesMaterialsAndNotWhereTheyAreEdited) {
  const std::shared_ptr<const scene::Scene> scene = wall();
  JitterRig rig(scene, before_wall(0.0f), false);
  std::vector<shared::Material> materials = scene->materials;
  const auto show_other = [&](render::PartChange change) {
    materials[0].roughness += 0.01f;
    rig.renderer.set_materials(materials, {}, change);
    rig.renderer.render();
  };
  rig.renderer.render();
  for (int i = 0; i < 3; ++i) show_other(render::PartChange::animation);
  EXPECT_EQ(shortest_history(rig), 3.0f) << "since there is a table of other materials";
  show_other(render::PartChange::edit);
  EXPECT_EQ(shortest_history(rig), 1.0f);
}

}  // namespace
}  // namespace heliograph::test
