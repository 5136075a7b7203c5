// Arbitrary bytes as an environment must give radiance that can be rendered, or an ImportError of
// one line that names the file.
#include <tbb/global_control.h>

#include <cstdlib>
#include <string_view>

#include "input_file.hpp"
#include "scene/environment.hpp"
#include "scene/image/exr.hpp"
#include "scene/image/radiance.hpp"
#include "scene/import_error.hpp"

using namespace heliograph;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check(const scene::Environment& environment) {
  require(environment.width > 0 && environment.height > 0);
  require(environment.radiance.size() == std::size_t{environment.width} * environment.height);
  for (const glm::vec3& radiance : environment.radiance) {
    for (int c = 0; c < 3; ++c) require(radiance[c] >= 0.0f && radiance[c] <= 1e6f);
  }
}

/// What a header of few bytes asks for takes longer than what the input could show.
bool is_large(std::span<const std::uint8_t> bytes) {
  constexpr std::uint64_t most_pixels = 1 << 16;
  try {
    if (scene::is_exr(bytes)) {
      scene::decode_exr(bytes, most_pixels);
    } else {
      scene::decode_radiance(bytes, most_pixels);
    }
    return false;
  } catch (const scene::ImportError&) {
    return true;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Coverage must not depend on the order of threads.
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  static const fuzz::InputFile file("sky");
  if (is_large({data, size})) return 0;
  file.write(data, size);
  try {
    check(scene::load_environment(file.path()));
  } catch (const scene::ImportError& refusal) {
    const std::string_view what = refusal.what();
    require(what.find("the environment sky") == 0 && what.find('\n') == std::string_view::npos);
  }
  return 0;
}
