// What changes must show soon, though a moving view leaves most samples out.
#include <gtest/gtest.h>

#include "shaders/shared/scene.h"
#include "tests/image/denoise/spheres.hpp"

namespace heliograph::test {
namespace {

constexpr int frames_before =
    40;  // long enough for histories of which one frame in eight is traced

scene::Camera slow_orbit(int frame) {
  const float angle = 0.01f * static_cast<float>(frame);
  return look({4.5f * std::sin(angle), 2, 4.5f * std::cos(angle)}, {0, 0.5f, 0});
}

/// What happens while the camera moves.
enum class Event { light_off, light_on, sky_dims };

const char* name_of(Event event) {
  return event == Event::light_off  ? "light_off"
         : event == Event::light_on ? "light_on"
                                    : "sky_dims";
}

/// Two suns, one of which `sun` dims.
std::vector<shared::Light> lights_of(const scene::Scene& scene, float sun) {
  std::vector<shared::Light> lights;
  for (const scene::Light& light : scene.lights) lights.push_back(light.device);
  lights[0].color *= sun;
  return lights;
}

class Film {
 public:
  explicit Film(const protocol::Settings& settings, Event event)
      : settings_(settings), event_(event), rig_(scene(), settings) {
    rig_.renderer.set_frame_seconds(1.0f / 30.0f);
  }

  /// The frame `after` the event, of a camera that moves all the time.
  render::Frame play(int after) {
    render::Frame shown;
    for (int i = -frames_before; i < after; ++i) {
      rig_.renderer.set_camera(slow_orbit(i));
      set(i >= 0);
      shown = rig_.renderer.render();
    }
    return shown;
  }

  render::Frame ground_truth(int after) {
    rig_.renderer.set_camera(slow_orbit(after - 1));
    set(true);
    return rig_.accumulate(192);
  }

 private:
  static const std::shared_ptr<const scene::Scene>& scene() {
    static const auto made = [] {
      auto two_suns = std::make_shared<scene::Scene>(*spheres_on_floor());
      two_suns->lights.push_back(two_suns->lights[0]);
      two_suns->lights[1].device.direction = glm::normalize(glm::vec3(0.7f, -1.0f, 0.2f));
      return std::shared_ptr<const scene::Scene>(std::move(two_suns));
    }();
    return made;
  }

  void set(bool happened) {
    if (event_ == Event::sky_dims) {
      settings_.environment.intensity = happened ? 0.2f : 1.0f;
      rig_.apply(settings_);
      return;
    }
    const bool on = happened == (event_ == Event::light_on);
    if (on == on_) return;
    on_ = on;
    rig_.renderer.set_lights(lights_of(*scene(), on ? 1.0f : 0.0f));
  }

  protocol::Settings settings_;
  Event event_;
  bool on_ = true;
  SpheresRig rig_;
};

class SampledByNeed : public testing::TestWithParam<Event> {};

TEST_P(SampledByNeed, LightingIsNotStale) {
  protocol::Settings all = denoised_only();
  all.sampling.visibility = all.sampling.specular = false;
  for (const int after : {4, 12}) {
    const std::string name = std::string(name_of(GetParam())) + "_" + std::to_string(after);
    const render::Frame truth = Film(noisy_only(), GetParam()).ground_truth(after);
    const render::Frame shown = Film(denoised_only(), GetParam()).play(after);
    const render::Frame sampled = Film(all, GetParam()).play(after);
    save_image(name, shown);
    save_image(name + "_all_samples", sampled);
    save_image(name + "_ground_truth", truth);
    const double error = difference(truth, shown).mean;
    const double least = difference(truth, sampled).mean;
    std::printf("%s: error %.3f, with all samples %.3f\n", name.c_str(), error, least);
    EXPECT_LT(error, 1.15 * least + 0.1) << after;
  }
}

INSTANTIATE_TEST_SUITE_P(Events, SampledByNeed,
                         testing::Values(Event::light_off, Event::light_on, Event::sky_dims),
                         [](const auto& event) { return std::string(name_of(event.param)); });

/// The spheres and their floor, without anything smooth.
std::shared_ptr<const scene::Scene> rough_spheres() {
  auto rough = std::make_shared<scene::Scene>(*spheres_on_floor());
  for (shared::Material& material : rough->materials) {
    material.roughness = 0.7f;
    material.metallic = 0.0f;
  }
  return rough;
}

/// Mean differences from each frame to the next, from the last one of a moving camera on.
std::vector<double> changes_at_rest(const protocol::Settings& settings) {
  SpheresRig rig(rough_spheres(), settings);
  rig.renderer.set_frame_seconds(1.0f / 30.0f);
  render::Frame before;
  for (int i = 0; i < frames_before; ++i) {
    rig.renderer.set_camera(slow_orbit(i));
    before = rig.renderer.render();
  }
  std::vector<double> changes;
  for (int i = 0; i < 24; ++i) {
    const render::Frame now = rig.renderer.render();
    changes.push_back(difference(before, now).mean);
    before = now;
  }
  return changes;
}

TEST(FadedReflections, LeadSmoothlyToTracedOnesWhenTheViewStops) {
  protocol::Settings settings = denoised_only();
  settings.sampling.specular = false;
  const std::vector<double> traced = changes_at_rest(settings);
  settings.sampling.specular = true;
  settings.specular.fade_fraction = 1.0f;
  for (const auto to :
       {protocol::FadedReflection::history, protocol::FadedReflection::environment}) {
    settings.specular.fade_to = to;
    const std::vector<double> faded = changes_at_rest(settings);
    for (std::size_t i = 0; i < faded.size(); ++i) {
      EXPECT_LT(faded[i], 1.5 * traced[i] + 0.3) << i << " to " << static_cast<int>(to);
    }
  }
}

}  // namespace
}  // namespace heliograph::test
