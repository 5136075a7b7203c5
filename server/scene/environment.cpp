#include "scene/environment.hpp"

#include <algorithm>
#include <string>

#include "scene/confined_folder.hpp"
#include "scene/image/exr.hpp"
#include "scene/image/radiance.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {

glm::vec3 physical_radiance(const glm::vec3& radiance) {
  constexpr float brightest = 1e6f;
  glm::vec3 result;
  for (int c = 0; c < 3; ++c) {
    result[c] = radiance[c] > 0.0f ? std::min(radiance[c], brightest) : 0.0f;
  }
  return result;
}

Environment decode_environment(std::span<const std::uint8_t> file) {
  Environment environment = is_exr(file) ? decode_exr(file) : decode_radiance(file);
  for (glm::vec3& radiance : environment.radiance) radiance = physical_radiance(radiance);
  return environment;
}

Environment load_environment(const std::filesystem::path& path) {
  const std::string what = "the environment " + path.filename().string();
  const std::vector<std::uint8_t> file = read_regular_file(path, most_environment_bytes, what);
  try {
    return decode_environment(file);
  } catch (const ImportError& error) {
    throw ImportError(what + " " + error.what());
  }
}

Environment constant_environment(const glm::vec3& radiance) {
  // Large enough for filters that read neighbors.
  Environment environment{8, 4, {}};
  environment.radiance.assign(std::size_t(environment.width) * environment.height, radiance);
  return environment;
}

}  // namespace heliograph::scene
