// Frames of a moving view of which nothing is read but what they show: they leave out their noisy
// radiance, its mean, and on GPUs the image of the background.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <string>
#include <vector>

#include "render/api/renderer.hpp"
#include "tests/support/engine.hpp"
#include "tests/support/frame_rig.hpp"
#include "tests/support/image_comparison.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/similarity.hpp"

namespace heliograph::test {
namespace {

constexpr int moved_frames = 6, static_frames = 5;

bool ran(const render::Frame& frame, std::string_view pass) {
  return std::ranges::find(frame.passes, pass, &render::PassTime::name) != frame.passes.end();
}

/// The parameter: whether the engine treats its device as a GPU, whatever it is.
class OnlyShown : public testing::TestWithParam<bool> {
 protected:
  OnlyShown()
      : engine_(render::EngineOptions{
            .device = device().report().name, .validation = true, .as_gpu = GetParam()}),
        renderer_(engine_) {
    SceneBuilder scene;
    scene.place(scene.add_sphere(0.8f, surface({0.9f, 0.3f, 0.2f}, 0.3f)),
                glm::translate(glm::mat4(1.0f), glm::vec3(0, 0.8f, 0)));
    auto veil = surface({0.2f, 0.4f, 0.9f}, 0.2f);
    veil.flags = shared::material_alpha_blend;
    veil.base_color.w = 0.5f;
    scene.place(scene.add_sphere(0.4f, veil),
                glm::translate(glm::mat4(1.0f), glm::vec3(0.5f, 1.2f, 1.0f)));
    scene.add_sun({0.3f, -1.0f, -0.5f}, {3, 2, 1}, 2.0f);
    renderer_.set_scene(engine_.upload(scene.build(), make_environment(32, [](const glm::vec3& d) {
                                         return glm::vec3(1.0f + d.x, 0.7f + 0.5f * d.y,
                                                          1.0f - d.z);
                                       })));
    renderer_.set_size(160, 90);
  }
  void TearDown() override { EXPECT_EQ(engine_.validation_messages(), 0u); }

  /// `more`: passes that go on from what is composed, or draw into the background.
  static protocol::Settings settings(bool more) {
    protocol::Settings made = without_indirect();
    made.lens.depth_of_field = more;
    made.background.ground = more ? protocol::GroundUse::on : protocol::GroundUse::off;
    made.reference.use = more ? protocol::ReferenceUse::when_static : protocol::ReferenceUse::off;
    made.accumulation.max_samples = 4;
    return made;
  }

  void look_from(int move) {
    renderer_.set_camera(look({0.1f * static_cast<float>(move), 2, 3}, {0, 0.9f, 0}));
  }

  /// Of a camera that moves and stops, and what has accumulated then.
  struct Sequence {
    std::vector<render::Frame> frames;
    render::FloatImage accumulated;
  };
  Sequence draw(bool keeps_buffers) {
    Sequence drawn;
    renderer_.reset();
    renderer_.invalidate_history();
    renderer_.keep_buffers(keeps_buffers);
    for (int i = 0; i < moved_frames + static_frames; ++i) {
      look_from(std::min(i, moved_frames));
      drawn.frames.push_back(renderer_.render());
    }
    renderer_.keep_buffers(true);
    drawn.frames.push_back(renderer_.render());
    drawn.accumulated = renderer_.capture("accumulated").value();
    return drawn;
  }

  render::Engine engine_;
  render::Renderer renderer_;
};

// Light that bounces depends on the order in which the device's threads come to its cache.
TEST_P(OnlyShown, ShowTheSameAndAccumulateTheSame) {
  for (const bool more : {false, true}) {
    ASSERT_TRUE(renderer_.set_settings(settings(more)));
    const Sequence all = draw(true), shown = draw(false);
    for (std::size_t i = 0; i < all.frames.size(); ++i) {
      EXPECT_EQ(all.frames[i].rgba, shown.frames[i].rgba) << "frame " << i << ", more " << more;
    }
    EXPECT_EQ(all.accumulated.rgba, shown.accumulated.rgba) << more;
    const std::string name = std::string("only_shown") + (more ? "_lens_ground" : "");
    save_image(name + "_moving", shown.frames[moved_frames - 1]);
    save_image(name + "_static", shown.frames.back());
  }
}

TEST_P(OnlyShown, HaveBuffersAsSoonAsTheyAreAskedFor) {
  ASSERT_TRUE(renderer_.set_settings(settings(false)));
  renderer_.keep_buffers(false);
  for (int i = 0; i < 3; ++i) {
    look_from(i);
    renderer_.render();
  }
  EXPECT_FALSE(renderer_.has_buffers());
  renderer_.keep_buffers(true);
  look_from(3);
  renderer_.render();
  EXPECT_TRUE(renderer_.has_buffers());
  // A moving view's mean is its newest sample, and its background that of this frame.
  const render::FloatImage mean = renderer_.capture("accumulated").value();
  const render::FloatImage noisy = renderer_.capture("hdr.noisy").value();
  for (std::uint32_t x = 0; x < 160; ++x) {
    EXPECT_EQ(glm::vec3(texel(mean, x, 45)), glm::vec3(texel(noisy, x, 45))) << x;
  }
  const render::FloatImage sky = renderer_.capture("skybox").value();
  const render::FloatImage hdr = renderer_.capture("hdr").value();
  EXPECT_EQ(texel(sky, 2, 2), texel(hdr, 2, 2));
}

TEST_P(OnlyShown, LeavePassesOut) {
  ASSERT_TRUE(renderer_.set_settings(settings(false)));
  renderer_.keep_buffers(false);
  EXPECT_TRUE(ran(renderer_.render(), "accumulate")) << "the first leaves no samples out";
  look_from(1);
  const render::Frame moving = renderer_.render();
  EXPECT_FALSE(ran(moving, "accumulate"));
  EXPECT_EQ(ran(moving, "skybox"), engine_.device().type == protocol::DeviceType::cpu);
  const render::Frame still = renderer_.render();
  EXPECT_TRUE(ran(still, "accumulate") && ran(still, "skybox"));
}

INSTANTIATE_TEST_SUITE_P(Devices, OnlyShown, testing::Bool(), [](const auto& test) {
  return std::string(test.param ? "AsGpu" : "AsItIs");
});

}  // namespace
}  // namespace heliograph::test
