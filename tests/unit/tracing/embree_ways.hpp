#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/support/traced_scene.hpp"
#include "tracing/embree/embree_batch.hpp"
#include "tracing/embree/embree_scene.hpp"

/// Every way to build a scene for Embree and to trace rays in it.
namespace heliograph::tracing {

struct Way {
  bool flat = true;
  bool robust = true;
  bool high_quality = false;
  bool coherent = false;
  std::size_t batch = embree_batch;
};

/// Instances only, watertight: closest to what the scene says.
inline constexpr Way reference_way{.flat = false};

/// Embree builds robust scenes of high quality in medium quality.
inline std::vector<Way> all_ways() {
  std::vector<Way> ways;
  for (const bool flat : {false, true}) {
    for (const bool robust : {false, true}) {
      for (const bool high_quality : {false, true}) {
        if (robust && high_quality) continue;
        for (const bool coherent : {false, true}) {
          ways.push_back({flat, robust, high_quality, coherent, coherent ? 256 : embree_batch});
        }
      }
    }
  }
  return ways;
}

inline std::string name_of(const Way& way) {
  return std::string(way.flat ? "Flat" : "Instanced") + (way.robust ? "Robust" : "Fast") +
         (way.high_quality ? "High" : "Medium") + (way.coherent ? "Coherent" : "");
}

inline std::string way_name(const testing::TestParamInfo<Way>& test) {
  return name_of(test.param);
}

struct TraceResults {
  std::vector<shared::Hit> hits;
  std::vector<std::uint32_t> occluded;
};

inline TraceResults trace(const EmbreeScenes& scenes, std::span<const shared::Ray> rays,
                          const Way& way, std::uint32_t blending = 0) {
  TraceResults results{std::vector<shared::Hit>(rays.size()),
                       std::vector<std::uint32_t>(rays.size())};
  for (std::size_t i = 0; i < rays.size(); i += way.batch) {
    const RayBatch batch{.rays = rays.subspan(i, std::min(way.batch, rays.size() - i)),
                         .blending = blending,
                         .coherent = way.coherent};
    intersect_batch(scenes, batch, &results.hits[i]);
    occluded_batch(scenes, batch, &results.occluded[i]);
  }
  return results;
}

/// A scene built in one way.
class WayThrough {
 public:
  /// `scene` outlives this object.
  WayThrough(const scene::Scene& scene, const Way& way)
      : way_(way),
        device_(make_embree_device()),
        built_(device_.get(), scene, scene.alpha_heap,
               {.flat = way.flat,
                .build = {way.robust,
                          way.high_quality ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM},
                .fast_copy = false}) {}

  TraceResults trace(std::span<const shared::Ray> rays, std::uint32_t blending = 0) const {
    return tracing::trace(built_.scenes(RayKind::path), rays, way_, blending);
  }

 private:
  Way way_;
  EmbreeHandle<RTCDevice> device_;
  EmbreeScene built_;
};

}  // namespace heliograph::tracing
