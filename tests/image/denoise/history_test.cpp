// Which pixels of a whole frame find themselves in the frame before: read from the map that the
// denoisers follow (xy: where, in pixels; z: which of four pixels; w: 1 where nowhere).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/scene_renderer.hpp"

namespace heliograph::test {
namespace {

constexpr float wall_distance = 4.0f;

/// A wall that faces the eye and fills the picture.
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

struct Viewed : Still {
  Viewed(std::shared_ptr<const scene::Scene> scene, const scene::Camera& camera, bool jitter,
         std::uint32_t width = 96, std::uint32_t height = 54)
      : Still(std::move(scene), scene::constant_environment(glm::vec3(1.0f)), camera, width,
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

/// Pixels across the wall at its distance for a metre.
float pixels_per_metre(std::uint32_t height, float fov = 45.0f) {
  const float half = wall_distance * std::tan(glm::radians(0.5f * fov));
  return static_cast<float>(height) / (2.0f * half);
}

// Jittered samples differ from frame to frame; where a resting surface was must not.
TEST(History, StaticViewMapsPixelToItselfDespiteJitter) {
  for (const bool jitter : {false, true}) {
    Viewed still(wall(), before_wall(0.3f), jitter);
    still.renderer.render();
    for (int i = 0; i < 4; ++i) {
      still.renderer.render();
      const render::FloatImage map = still.capture("denoise.reprojection");
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

// Normals that lost precision on their way into the history would differ from themselves, most on
// what is curved.
TEST(History, NormalsAreBitExactInHistory) {
  Viewed still(ball(), look({0.4f, 0.3f, 3}, {0, 0, 0}), false);
  still.renderer.render();
  const render::FloatImage first = still.capture("gbuffer.normals");
  still.renderer.render();
  EXPECT_EQ(first.rgba, still.capture("gbuffer.normals").rgba);
  const render::FloatImage map = still.capture("denoise.reprojection");
  for (std::size_t i = 3; i < map.rgba.size(); i += 4) ASSERT_EQ(map.rgba[i], 0.0f) << i / 4;
}

// In 16 bits a motion of a hundredth of a pixel is none, and pixels creep.
TEST(History, ResolvesMotionOfHundredthOfPixel) {
  const std::uint32_t width = 1919, height = 8;
  const float fov = 0.5f;
  Viewed still(wall(), before_wall(0.0f, wall_distance, fov), false, width, height);
  still.renderer.render();
  still.show(before_wall(0.01f / pixels_per_metre(height, fov), wall_distance, fov));
  const render::FloatImage motion = still.capture("gbuffer.motion");
  for (std::size_t i = 0; i < motion.rgba.size(); i += 4) {
    ASSERT_NEAR(motion.rgba[i] * static_cast<float>(width), 0.01f, 1e-3f) << i / 4;
    ASSERT_NEAR(motion.rgba[i + 1] * static_cast<float>(height), 0.0f, 1e-3f) << i / 4;
  }
}

TEST(History, DisoccludedColumnsHaveNoHistory) {
  for (const float columns : {-3.7f, 3.7f}) {
    Viewed still(wall(), before_wall(0.0f), true);
    const float step = columns / pixels_per_metre(54);
    float x = 0.0f;
    for (int i = 0; i < 6; ++i) still.show(before_wall(x += step));
    const render::FloatImage map = still.capture("denoise.reprojection");
    const render::FloatImage history = still.capture("visibility.history");
    for (std::uint32_t row = 0; row < map.height; ++row) {
      for (std::uint32_t column = 0; column < map.width; ++column) {
        const std::size_t at = (std::size_t{row} * map.width + column) * 4;
        const float was = static_cast<float>(column) + columns;
        // Beyond the 3x3 pixels in which a lost surface is looked for.
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

// Depth without its motion would refuse every pixel of a wall that comes nearer.
TEST(History, IsValidWhileCameraApproaches) {
  Viewed still(wall(), before_wall(0.0f), true);
  for (int i = 0; i < 6; ++i) {
    still.show(before_wall(0.0f, wall_distance - 0.25f * static_cast<float>(i)));
  }
  const render::FloatImage map = still.capture("denoise.reprojection");
  for (std::size_t i = 3; i < map.rgba.size(); i += 4) ASSERT_EQ(map.rgba[i], 0.0f) << i / 4;
}

// What a switch changes is not in the memory that it leaves.
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
    Viewed still(ball(), look({0.4f, 0.3f, 3}, {0, 0, 0}), true);
    protocol::Settings settings;
    for (int i = 0; i < 4; ++i) still.renderer.render();
    change(settings);
    still.apply(settings);
    still.renderer.render();
    for (const char* signal : {"visibility.history", "specular.history"}) {
      const render::FloatImage history = still.capture(signal);
      for (std::size_t i = 0; i < history.rgba.size(); i += 4) {
        ASSERT_LE(history.rgba[i], 1.0f) << signal << " after " << name;
      }
    }
  }
}

// Nothing else answers rays or makes the G-buffer than what was asked for.
TEST(EffectivePipeline, MatchesRequestedTracerAndPasses) {
  for (const auto& [tracer, kind, pass] :
       {std::tuple{"embree", protocol::TracerKind::embree, protocol::PassKind::host},
        {"software", protocol::TracerKind::software, protocol::PassKind::device}}) {
    if (!is_offered(tracer)) continue;
    EXPECT_EQ(engine(tracer).tracer(), kind);
    Still still(ball(), scene::constant_environment(glm::vec3(1.0f)),
                look({0.4f, 0.3f, 3}, {0, 0, 0}), 32, 18, tracer);
    for (const auto source :
         {protocol::PrimaryVisibility::raster, protocol::PrimaryVisibility::rays}) {
      for (const bool denoised : {false, true}) {
        protocol::Settings settings;
        settings.gbuffer.source = source;
        settings.shadow_temporal.enabled = settings.shadow_blur.enabled = denoised;
        settings.specular_temporal.enabled = settings.specular_blur.enabled = denoised;
        still.apply(settings);
        const render::Frame frame = still.renderer.render();
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
        EXPECT_EQ(passes("gbuffer") > 0, source == protocol::PrimaryVisibility::raster);
        EXPECT_EQ(passes("visibility.temporal") > 0, denoised);
        EXPECT_EQ(passes("specular.temporal") > 0, denoised);
      }
    }
  }
}

}  // namespace
}  // namespace heliograph::test
