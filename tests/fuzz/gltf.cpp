// Arbitrary bytes must give a scene or an ImportError of one line.
#include <tbb/global_control.h>

#include <cstdlib>

#include "document_mutator.hpp"
#include "input_file.hpp"
#include "scene/animation/pose.hpp"
#include "scene/import.hpp"

using namespace heliograph;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

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
  static const fuzz::InputFile file("scene.glb");
  static const scene::ImportLimits limits{.file_bytes = 1 << 20,
                                          .unpacked_bytes = 1 << 20,
                                          .scene_bytes = 64 << 20,
                                          .triangles = 20'000,
                                          .texels = 1 << 18,
                                          .texture_size = 2048,
                                          .nodes = 1000,
                                          .instances = 1000};
  file.write(data, size);
  try {
    play(scene::import_gltf(file.path(), limits));
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
