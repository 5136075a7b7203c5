// Vectors of three numbers in memory, for work lane by lane. Included once per instruction set.
#if defined(HELIOGRAPH_KERNELS_STORED_TRIPLES_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_STORED_TRIPLES_HPP
#undef HELIOGRAPH_KERNELS_STORED_TRIPLES_HPP
#else
#define HELIOGRAPH_KERNELS_STORED_TRIPLES_HPP
#endif

#include <array>

#include "render/kernels/simd/lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Three numbers of every lane in memory.
struct StoredTriples {
  HWY_ALIGN std::array<float, hn::MaxLanes(Tag())> x, y, z;
  StoredTriples() = default;
  HWY_INLINE explicit StoredTriples(const Float3& v) {
    hn::Store(v.x, tag, x.data());
    hn::Store(v.y, tag, y.data());
    hn::Store(v.z, tag, z.data());
  }
  glm::vec3 at(std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
  void put(std::size_t lane, const glm::vec3& v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
  HWY_INLINE Float3 load() const {
    return {hn::Load(tag, x.data()), hn::Load(tag, y.data()), hn::Load(tag, z.data())};
  }
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
