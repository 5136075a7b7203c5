#include "scenes/generator/scenes/paper_scenes.hpp"

#include <stdexcept>
#include <string>

#include "scenes/generator/atrium/atrium.hpp"

namespace heliograph::scenes {
namespace {

template <int case_number>
Document make_atrium_case(const PaperScene&, const ClearSky& sky) {
  return make_atrium(case_number, sky);
}

constexpr Sun atrium_sun{sun_elevation, sun_azimuth};

}  // namespace

ClearSky PaperScene::make_sky(int width, int height) const {
  ClearSky sky = make_clear_sky(direction_to_sun(sun.elevation, sun.azimuth), width, height);
  for (glm::vec3& radiance : sky.environment.radiance) radiance *= daylight;
  sky.sun_irradiance *= daylight;
  sky.sky_irradiance *= daylight;
  return sky;
}

const std::array<PaperScene, 8>& paper_scenes() {
  static const std::array<PaperScene, 8> scenes = {{
      {"cubes_distance", {50.0f, 30.0f}, 0.7f, make_cubes_distance},
      {"icosphere", {55.0f, -40.0f}, 0.6f, make_icosphere_scene},
      {"glossy_sponza_1", atrium_sun, 1.0f, make_atrium_case<1>},
      {"glossy_sponza_2", atrium_sun, 1.0f, make_atrium_case<2>},
      {"glossy_sponza_3", atrium_sun, 1.0f, make_atrium_case<3>},
      {"shadow_objects", {40.0f, 35.0f, 2.0f}, 0.42f, make_shadow_objects},
      {"pillars", {22.0f, 60.0f, 2.0f}, 0.45f, make_pillars},
      {"breakfast_room", {35.0f, 90.0f, 2.0f}, 1.5f, make_breakfast_room},
  }};
  return scenes;
}

const PaperScene& find_paper_scene(std::string_view name) {
  for (const PaperScene& scene : paper_scenes()) {
    if (scene.name == name) return scene;
  }
  throw std::invalid_argument("there is no scene of the paper named " + std::string(name));
}

}  // namespace heliograph::scenes
