#include "scenes/generator/sky/sunlight.hpp"

#include <algorithm>

namespace heliograph::scenes {

void add_sun(Document& document, const Sun& sun, const ClearSky& sky) {
  const glm::vec3 irradiance = sky.sun_irradiance;
  const float strongest = std::max({irradiance.x, irradiance.y, irradiance.z});
  Light light;
  light.name = "sun";
  light.directional = true;
  light.color = irradiance / strongest;
  light.intensity = strongest;
  Node node;
  node.translation = {0.0f, 20.0f, 0.0f};
  node.rotation = look_rotation(direction_to_sun(sun.elevation, sun.azimuth), glm::vec3(0.0f));
  node.angular_diameter = sun.angular_diameter;
  document.add_light(std::move(light), std::move(node));
}

}  // namespace heliograph::scenes
