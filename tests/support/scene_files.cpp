#include "tests/support/scene_files.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "scene/import.hpp"
#include "scenes/generator/gltf/glb.hpp"

namespace heliograph::test {

std::shared_ptr<const scene::Scene> import_document(const scenes::Document& document,
                                                    int texture_size) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("heliograph-test-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const fs::path path = folder / (document.name + ".glb");
  const auto bytes = scenes::encode_glb(document, texture_size);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  auto scene = std::make_shared<const scene::Scene>(scene::import_gltf(path));
  fs::remove_all(folder);
  return scene;
}

scene::Environment convert(const scenes::Environment& environment) {
  return {static_cast<std::uint32_t>(environment.width),
          static_cast<std::uint32_t>(environment.height), environment.radiance};
}

std::optional<std::filesystem::path> asset(const std::filesystem::path& path) {
  const char* folder = std::getenv("HELIOGRAPH_TEST_ASSETS");
  if (!folder || !*folder) return std::nullopt;
  return std::filesystem::path(folder) / path;
}

}  // namespace heliograph::test
