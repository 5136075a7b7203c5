#include "render/kernels/common/parallel.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace heliograph::render::kernels {

void for_each_range(int count, int grain, RangeWork work) {
  const int ranges = (count + grain - 1) / grain;
  tbb::parallel_for(tbb::blocked_range<int>(0, ranges, 1), [&](const auto& some) {
    for (int range = some.begin(); range < some.end(); ++range) {
      work(range * grain, std::min((range + 1) * grain, count));
    }
  });
}

int processors() {
  return tbb::this_task_arena::max_concurrency();
}

}  // namespace heliograph::render::kernels
