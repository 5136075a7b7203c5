#include "scenes/generator/sky/studio.hpp"

#include "scene/studio.hpp"

namespace heliograph::scenes {

Environment make_studio(int width, int height) {
  Environment studio(width, height);
  studio.radiance = scene::studio_radiance(width, height);
  return studio;
}

}  // namespace heliograph::scenes
