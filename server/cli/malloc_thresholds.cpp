#include "cli/malloc_thresholds.hpp"

#include <malloc.h>

namespace heliograph::cli {

void set_malloc_thresholds(const render::Engine& engine) {
  if (engine.device().type != protocol::DeviceType::cpu) return;
#ifdef __GLIBC__
  constexpr int mmap_threshold_bytes = 1 << 20;
  constexpr int trim_threshold_bytes = 16 << 20;
  mallopt(M_MMAP_THRESHOLD, mmap_threshold_bytes);
  mallopt(M_TRIM_THRESHOLD, trim_threshold_bytes);
#endif
}

}  // namespace heliograph::cli
