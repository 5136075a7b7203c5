#include "scene/environment.hpp"

#include <cmath>

#include "scene/confined_folder.hpp"
#include "scene/image_decoder.hpp"
#include "scene/import.hpp"

namespace heliograph::scene {

Environment load_environment(const std::filesystem::path& path) {
  constexpr std::uint64_t max_bytes = 512ull << 20;
  const std::vector<std::uint8_t> file = read_regular_file(path, max_bytes, "the environment");
  Environment environment;
  try {
    const ImageSize size = probe_radiance(file);
    environment.width = size.width;
    environment.height = size.height;
    environment.radiance = decode_radiance(file, size);
  } catch (const ImportError& error) {
    throw ImportError(std::string("the environment ") + error.what());
  }
  for (const glm::vec3& texel : environment.radiance) {
    for (int channel = 0; channel < 3; ++channel) {
      if (!std::isfinite(texel[channel]) || texel[channel] < 0.0f) {
        throw ImportError("the environment holds radiance that is negative or not finite");
      }
    }
  }
  return environment;
}

Environment constant_environment(const glm::vec3& radiance) {
  // Wide enough that filters which look at neighbours have some.
  Environment environment{8, 4, {}};
  environment.radiance.assign(std::size_t(environment.width) * environment.height, radiance);
  return environment;
}

}  // namespace heliograph::scene
