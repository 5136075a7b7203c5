#include "scene/environment.hpp"

#include "scene/confined_folder.hpp"
#include "scene/import.hpp"
#include "scene/radiance.hpp"

namespace heliograph::scene {

Environment load_environment(const std::filesystem::path& path) {
  constexpr std::uint64_t max_bytes = 512ull << 20;
  const std::vector<std::uint8_t> file = read_regular_file(path, max_bytes, "the environment");
  try {
    return decode_radiance(file);
  } catch (const ImportError& error) {
    throw ImportError(std::string("the environment ") + error.what());
  }
}

Environment constant_environment(const glm::vec3& radiance) {
  // Wide enough that filters which look at neighbours have some.
  Environment environment{8, 4, {}};
  environment.radiance.assign(std::size_t(environment.width) * environment.height, radiance);
  return environment;
}

}  // namespace heliograph::scene
