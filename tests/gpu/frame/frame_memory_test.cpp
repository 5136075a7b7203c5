#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "render/frame/frame.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

using Change = void (*)(protocol::Settings&);

/// A sphere in front of the sky, so that some pixels have neither surface nor rays.
std::shared_ptr<const scene::Scene> sphere_and_sun() {
  SceneBuilder scene;
  const auto ground = scene.add_quad(
      {glm::vec3(-2, -1, 2), glm::vec3(2, -1, 2), glm::vec3(2, -1, -2), glm::vec3(-2, -1, -2)},
      surface({0.5f, 0.6f, 0.7f}, 0.8f));
  scene.place(ground);
  scene.place(scene.add_sphere(0.8f, surface({0.9f, 0.8f, 0.7f}, 0.2f, 1.0f)));
  scene.add_sun({0.3f, -0.5f, -1.0f}, {3, 2, 1}, 0.01f);
  return scene.build();
}

/// Whole frames on devices that are processors.
class FrameMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "only CPU devices share memory";
  }

  struct Frame {
    Frame(const protocol::Settings& settings, VkExtent2D extent, bool shares)
        : rig(sphere_and_sun(), look({0, 0.4f, 4}, {0, 0, 0}),
              {.extent = extent, .settings = settings, .tracer = "embree"}),
          takes_over(settings.reference.use == protocol::ReferenceUse::when_static) {
      if (shares) rig.plan().share_memory();
      const auto outputs = render::declare_frame(rig.plan(), rig.inputs());
      rig.plan().read_back(outputs.output);
    }
    void run(int number) {
      if (number > 0) rig.set_view(look({0.1f * number, 0.4f, 4}, {0, 0, 0}), number);
      if (takes_over && number > 1) rig.let_reference_take_over();
      rig.run();
    }
    FrameRig rig;
    bool takes_over;
  };

  static double bytes_per_pixel(const protocol::Settings& settings, bool shares) {
    constexpr VkExtent2D extent{1280, 720};
    Frame frame(settings, extent, shares);
    frame.run(0);
    return static_cast<double>(frame.rig.plan().memory_bytes()) / (extent.width * extent.height);
  }

  using Bytes = std::pair<const std::byte*, const std::byte*>;
  static Bytes bytes_of(const gpu::Image& image) {
    const std::byte* const first = image.host().data;
    return {first, first + image.host().row_pitch * image.desc().extent.height};
  }

  /// Fills whatever shares memory with bits that are not a number in any format, but for what the
  /// frame before has left in histories, and what of these not every frame writes.
  static void poison(const gpu::FramePlan& plan) {
    std::vector<Bytes> left;
    for (const auto& view : plan.views()) {
      if (!plan.is_history(view.image)) continue;
      left.push_back(bytes_of(plan.latest(view.image)));
      const bool written = !plan.keeps_images() && plan.holds(view.image);
      if (!written) left.push_back(bytes_of(plan.get(view.image)));
    }
    for (const auto& view : plan.views()) {
      const gpu::Image& image = plan.get(view.image);
      if (!image.block()) continue;
      const Bytes own = bytes_of(image);
      const bool overlaps = std::ranges::any_of(left, [&](const Bytes& other) {
        return own.first < other.second && other.first < own.second;
      });
      if (overlaps) continue;
      for (std::uint32_t y = 0; y < image.desc().extent.height; ++y) {
        std::memset(image.host().row<std::byte>(y), 0xff,
                    std::size_t{image.desc().extent.width} * gpu::texel_bytes(image.desc().format));
      }
    }
  }

  /// The names of images that differ in any of a few frames of a moving view. `keeps`: all images
  /// are kept, as from the `switched`th frame on in any case. Without `all_buffers` frames leave
  /// out what they do not show.
  static std::string differences(const protocol::Settings& settings, bool keeps, int switched = 9,
                                 bool all_buffers = true) {
    constexpr VkExtent2D extent{70, 45};
    Frame own(settings, extent, false), sharing(settings, extent, true);
    for (Frame* frame : {&own, &sharing}) frame->rig.read_all_buffers(all_buffers);
    std::string names;
    for (int number = 0; number < 4; ++number) {
      sharing.rig.plan().keep_images(keeps || number >= switched);
      if (number > 0) poison(sharing.rig.plan());
      own.run(number);
      sharing.run(number);
      const auto& views = own.rig.plan().views();
      for (std::size_t i = 0; i < views.size(); ++i) {
        const auto image = views[i].image;
        if (!sharing.rig.plan().holds(sharing.rig.plan().views()[i].image)) continue;
        if (own.rig.plan().latest(image).download() !=
            sharing.rig.plan().latest(sharing.rig.plan().views()[i].image).download()) {
          names += views[i].name + " ";
        }
      }
      if (own.rig.plan().read() != sharing.rig.plan().read()) names += "(output) ";
    }
    return names;
  }
};

TEST_F(FrameMemory, SharingChangesNoImageOfAnyFrame) {
  const std::pair<const char*, Change> cases[] = {
      {"defaults", [](protocol::Settings&) {}},
      {"no shadows", [](protocol::Settings& s) { s.shadows.enabled = false; }},
      {"no ambient occlusion", [](protocol::Settings& s) { s.ambient.occlusion = false; }},
      {"no visibility",
       [](protocol::Settings& s) { s.shadows.enabled = s.ambient.occlusion = false; }},
      {"no reflections", [](protocol::Settings& s) { s.specular.enabled = false; }},
      {"no filters",
       [](protocol::Settings& s) {
         s.shadow_temporal.enabled = s.shadow_blur.enabled = false;
         s.specular_temporal.enabled = s.specular_blur.enabled = false;
       }},
      {"reference",
       [](protocol::Settings& s) { s.reference.use = protocol::ReferenceUse::always; }},
      {"reference of static views",
       [](protocol::Settings& s) { s.reference.use = protocol::ReferenceUse::when_static; }},
      {"global illumination of static views",
       [](protocol::Settings& s) {
         s.reference.use = protocol::ReferenceUse::when_static;
         s.reference.scope = protocol::ReferenceScope::full;
       }},
      {"automatic exposure",
       [](protocol::Settings& s) { s.exposure.mode = protocol::ExposureMode::automatic; }},
  };
  for (const auto& [name, change] : cases) {
    protocol::Settings settings;
    change(settings);
    EXPECT_EQ(differences(settings, true), "") << name;
    EXPECT_EQ(differences(settings, false), "") << name << ", not kept";
  }
}

TEST_F(FrameMemory, SharingChangesNoFrameThatIsOnlyShown) {
  for (const bool lens : {false, true}) {
    for (const auto reference :
         {protocol::ReferenceUse::off, protocol::ReferenceUse::when_static}) {
      protocol::Settings settings;
      settings.lens.depth_of_field = lens;
      settings.reference.use = reference;
      settings.exposure.mode = protocol::ExposureMode::automatic;
      EXPECT_EQ(differences(settings, false, 9, false), "") << lens;
    }
  }
}

TEST_F(FrameMemory, KeepingImagesFromSomeFrameOnChangesNone) {
  EXPECT_EQ(differences({}, false, 2), "");
}

TEST_F(FrameMemory, WhatIsTurnedOnAgainReadsNothingThatWasLeftOut) {
  constexpr VkExtent2D extent{70, 45};
  protocol::Settings without;
  without.shadows.enabled = without.ambient.occlusion = false;
  Frame own(without, extent, false), sharing(without, extent, true);
  for (int number = 0; number < 5; ++number) {
    if (number > 0) poison(sharing.rig.plan());
    for (Frame* const frame : {&own, &sharing}) {
      if (number == 2) {
        frame->rig.set_settings({});
        frame->rig.invalidate_history();
      }
      frame->run(number);
    }
    EXPECT_EQ(own.rig.plan().read(), sharing.rig.plan().read()) << "frame " << number;
  }
}

TEST_F(FrameMemory, PixelOfAFrameTakesHalfOfItsResources) {
  EXPECT_LT(bytes_per_pixel(without_indirect(), true), 325.0);
  EXPECT_GT(bytes_per_pixel(without_indirect(), false), 650.0);
  // Indirect light besides, and the radiance cache.
  EXPECT_LT(bytes_per_pixel({}, true), 370.0);
  EXPECT_GT(bytes_per_pixel({}, false), 890.0);
}

TEST_F(FrameMemory, CanceledFrameLeavesHistoriesAsTheyWere) {
  constexpr VkExtent2D extent{70, 45};
  Frame whole({}, extent, true), canceled({}, extent, true);
  whole.run(0);
  canceled.run(0);
  for (int after = 1; after < 28; after += 3) {
    int passes = 0;
    EXPECT_FALSE(canceled.rig.plan().execute([&] { return ++passes > after; }));
  }
  whole.run(1);
  canceled.run(1);
  EXPECT_EQ(whole.rig.plan().read(), canceled.rig.plan().read());
}

}  // namespace
}  // namespace heliograph::test
