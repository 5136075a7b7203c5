#include "tests/support/generated_scene.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "scene/import.hpp"
#include "scenes/generator/gltf/glb.hpp"

namespace heliograph::test {
namespace {

namespace fs = std::filesystem;

/// A temporary folder, removed by the destructor.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "heliograph_test_XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("cannot make a temporary folder");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

scene::Scene import_generated(const scenes::Document& document, int texture_size) {
  const std::vector<std::uint8_t> file = scenes::encode_glb(document, texture_size);
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "scene.glb";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
  return scene::import_gltf(path);
}

scene::Environment import_generated(const scenes::Environment& sky) {
  return {.width = static_cast<std::uint32_t>(sky.width),
          .height = static_cast<std::uint32_t>(sky.height),
          .radiance = sky.radiance};
}

}  // namespace heliograph::test
