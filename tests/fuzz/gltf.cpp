// Arbitrary bytes must give a scene or an ImportError of one line.
#include <tbb/global_control.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "document_mutator.hpp"
#include "scene/animation/pose.hpp"
#include "scene/import.hpp"

using namespace heliograph;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

/// A folder in shared memory where available, for one file that is rewritten for each input.
class Folder {
 public:
  Folder() {
    const std::filesystem::path memory = "/dev/shm";
    const std::filesystem::path parent =
        std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    path_ = parent / ("heliograph-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directory(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path file() const { return path_ / "scene.glb"; }

 private:
  std::filesystem::path path_;
};

/// A scene that loads must also animate.
void play(const scene::Scene& scene) {
  scene::Pose pose = scene::rest_pose(scene);
  for (const scene::Clip& clip : scene.clips) {
    scene::evaluate(scene, clip, 0.37 * clip.duration, pose);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Coverage must not depend on the order of threads.
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  static const Folder folder;
  static const std::filesystem::path path = folder.file();
  static const scene::ImportLimits limits{.file_bytes = 1 << 20,
                                          .unpacked_bytes = 1 << 20,
                                          .scene_bytes = 64 << 20,
                                          .triangles = 20'000,
                                          .texels = 1 << 18,
                                          .texture_size = 2048,
                                          .nodes = 1000,
                                          .instances = 1000};
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    play(scene::import_gltf(path, limits));
  } catch (const scene::ImportError& refusal) {
    for (const char* c = refusal.what(); *c; ++c) {
      if (*c < 0x20 || *c == 0x7f) std::abort();
    }
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  std::mt19937 random(seed);
  return fuzz::mutate_document(data, size, most, random, LLVMFuzzerMutate);
}
