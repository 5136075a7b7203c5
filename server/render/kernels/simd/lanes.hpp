// Surfaces and rays in vectors whose lanes lie anywhere: each reads its own records of the scene's
// tables. Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_LANES_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_LANES_HPP
#undef HELIOGRAPH_KERNELS_LANES_HPP
#else
#define HELIOGRAPH_KERNELS_LANES_HPP
#endif

#include <array>
#include <cstddef>
#include <cstring>
#include <glm/glm.hpp>

#include "hwy/contrib/math/math-inl.h"
#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<float>;
using IntegerTag = hn::RebindToSigned<Tag>;
using UnsignedTag = hn::RebindToUnsigned<Tag>;
using Float = hn::Vec<Tag>;
using Integer = hn::Vec<IntegerTag>;
using Unsigned = hn::Vec<UnsignedTag>;
using Mask = hn::Mask<Tag>;

inline constexpr Tag tag{};
inline constexpr IntegerTag integer_tag{};
inline constexpr UnsignedTag unsigned_tag{};

HWY_INLINE Float number(float value) {
  return hn::Set(tag, value);
}
HWY_INLINE Integer integer(int value) {
  return hn::Set(integer_tag, value);
}
HWY_INLINE Unsigned bits(std::uint32_t value) {
  return hn::Set(unsigned_tag, value);
}
HWY_INLINE Float zero() {
  return hn::Zero(tag);
}
HWY_INLINE Float one() {
  return number(1.0f);
}
HWY_INLINE Integer as_integer(Float v) {
  return hn::BitCast(integer_tag, v);
}
HWY_INLINE Unsigned as_unsigned(Float v) {
  return hn::BitCast(unsigned_tag, v);
}
HWY_INLINE Unsigned as_unsigned(Integer v) {
  return hn::BitCast(unsigned_tag, v);
}
HWY_INLINE Integer as_integer(Unsigned v) {
  return hn::BitCast(integer_tag, v);
}
HWY_INLINE Float as_float(Integer v) {
  return hn::BitCast(tag, v);
}
HWY_INLINE Float as_float(Unsigned v) {
  return hn::BitCast(tag, v);
}
HWY_INLINE Float to_float(Integer v) {
  return hn::ConvertTo(tag, v);
}
HWY_INLINE Integer truncated(Float v) {
  return hn::ConvertTo(integer_tag, v);
}
HWY_INLINE Mask float_mask(hn::Mask<IntegerTag> m) {
  return hn::RebindMask(tag, m);
}
HWY_INLINE Mask float_mask(hn::Mask<UnsignedTag> m) {
  return hn::RebindMask(tag, m);
}
HWY_INLINE hn::Mask<IntegerTag> integer_mask(Mask m) {
  return hn::RebindMask(integer_tag, m);
}

HWY_INLINE Float select(Mask m, Float yes, Float no) {
  return hn::IfThenElse(m, yes, no);
}
HWY_INLINE Integer select(Mask m, Integer yes, Integer no) {
  return hn::IfThenElse(integer_mask(m), yes, no);
}
HWY_INLINE Float at_least(Float v, float low) {
  return hn::Max(v, number(low));
}
HWY_INLINE bool none(Mask m) {
  return hn::AllFalse(tag, m);
}
HWY_INLINE bool all(Mask m) {
  return hn::AllTrue(tag, m);
}

/// A bit for every lane, the first lowest.
HWY_INLINE std::uint64_t mask_bits(Mask m) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(tag, m, bytes.data());
  std::uint64_t lanes;
  std::memcpy(&lanes, bytes.data(), sizeof lanes);
  return lanes;
}

using Float2 = Pair<Float>;
using Float3 = Triple<Float>;
using Float4 = Quad<Float>;

HWY_INLINE Float3 numbers(const glm::vec3& v) {
  return {number(v.x), number(v.y), number(v.z)};
}
HWY_INLINE Float3 numbers(float v) {
  return {number(v), number(v), number(v)};
}

/// a * b + c
HWY_INLINE Float3 multiply_add(const Float3& a, Float b, const Float3& c) {
  return {hn::MulAdd(a.x, b, c.x), hn::MulAdd(a.y, b, c.y), hn::MulAdd(a.z, b, c.z)};
}
HWY_INLINE Float3 multiply_add(const Float3& a, const Float3& b, const Float3& c) {
  return {hn::MulAdd(a.x, b.x, c.x), hn::MulAdd(a.y, b.y, c.y), hn::MulAdd(a.z, b.z, c.z)};
}
HWY_INLINE Float3 keep(Mask m, const Float3& v) {
  return {hn::IfThenElseZero(m, v.x), hn::IfThenElseZero(m, v.y), hn::IfThenElseZero(m, v.z)};
}
HWY_INLINE Float3 cross(const Float3& a, const Float3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
HWY_INLINE Float3 clamped(const Float3& v, float low, float high) {
  return {clamped(v.x, low, high), clamped(v.y, low, high), clamped(v.z, low, high)};
}
HWY_INLINE Float3 reflect(const Float3& v, const Float3& n) {
  return v - n * hn::Mul(number(2.0f), dot(n, v));
}
/// `m` x (v, 1); the columns of a matrix that is the same for all lanes.
HWY_INLINE Float3 transform_point(const glm::mat4& m, const Float3& v) {
  return multiply_add(
      numbers(glm::vec3(m[0])), v.x,
      multiply_add(numbers(glm::vec3(m[1])), v.y,
                   multiply_add(numbers(glm::vec3(m[2])), v.z, numbers(glm::vec3(m[3])))));
}
HWY_INLINE Float3 transform_direction(const glm::mat4& m, const Float3& v) {
  return multiply_add(numbers(glm::vec3(m[0])), v.x,
                      multiply_add(numbers(glm::vec3(m[1])), v.y, numbers(glm::vec3(m[2])) * v.z));
}
/// A row of `m` x (v, 1).
HWY_INLINE Float transform_row(const glm::mat4& m, int row, const Float3& v) {
  return hn::MulAdd(
      number(m[0][row]), v.x,
      hn::MulAdd(number(m[1][row]), v.y, hn::MulAdd(number(m[2][row]), v.z, number(m[3][row]))));
}

/// Word of a struct's member.
#define HELIOGRAPH_WORD(type, member) static_cast<int>(offsetof(type, member) / 4)

/// One record per lane in a table of 32-bit words. Lanes that read the same record, as neighbours
/// mostly do, read it once.
class Records {
 public:
  /// `stride` in words.
  HWY_INLINE Records(const void* table, Integer index, int stride)
      : words_(static_cast<const float*>(table)) {
    const Integer offset = hn::Mul(index, integer(stride));
    shared_ = words_ + hn::GetLane(offset);
    same_ = hn::AllTrue(integer_tag, hn::Eq(offset, integer(hn::GetLane(offset))));
    if (!same_) offset_ = LaneIndices<Tag>(offset);
  }

  HWY_INLINE Float real(int word) const {
    if (!same_) {
      return hn::GatherIndex(tag, words_ + word, hn::Load(integer_tag, offset_.of.data()));
    }
    return shared(word);
  }
  HWY_INLINE Integer whole(int word) const { return as_integer(real(word)); }
  /// Words `word` to `word` + 3.
  HWY_INLINE Float4 four(int word) const {
    if (same_) return {shared(word), shared(word + 1), shared(word + 2), shared(word + 3)};
    return four_words(tag, [&](std::size_t lane) { return words_ + word + offset_.of[lane]; });
  }
  /// Three words; a fourth of the record follows them.
  HWY_INLINE Float3 triple(int word) const {
    const Float4 words = four(word);
    return {words.x, words.y, words.z};
  }

 private:
  HWY_INLINE Float shared(int word) const {
    float value;
    std::memcpy(&value, shared_ + word, sizeof value);
    return number(value);
  }

  const float* words_;
  const float* shared_;
  LaneIndices<Tag> offset_;  // where lanes differ
  bool same_;
};

HWY_INLINE Integer gather(const void* words, Integer index) {
  return hn::GatherIndex(integer_tag, static_cast<const int*>(words), index);
}
HWY_INLINE Float gather(const float* numbers, Integer index) {
  return hn::GatherIndex(tag, numbers, index);
}

/// Four numbers of 0 to 1 in eight bits each.
HWY_INLINE Integer pack_unorm8(const Float4& v) {
  const auto byte = [](Float value) {
    return truncated(hn::MulAdd(clamped(value, 0.0f, 1.0f), number(255.0f), number(0.5f)));
  };
  return hn::Or(hn::Or(byte(v.x), hn::ShiftLeft<8>(byte(v.y))),
                hn::Or(hn::ShiftLeft<16>(byte(v.z)), hn::ShiftLeft<24>(byte(v.w))));
}

HWY_INLINE Float4 unpack_unorm8(Integer packed) {
  const Unsigned bytes = as_unsigned(packed);
  return {unorm8<0>(tag, bytes), unorm8<8>(tag, bytes), unorm8<16>(tag, bytes),
          unorm8<24>(tag, bytes)};
}

/// The bits of a half float, rounded to the nearest. `v` >= 0.
HWY_INLINE Unsigned half_bits(Float v) {
  // Scaled by 2^-112 the exponent is a half's; what has none is then denormal in both.
  const Unsigned scaled = as_unsigned(hn::Min(v, number(65504.0f)) * number(0x1p-112f));
  const Unsigned odd = hn::And(hn::ShiftRight<13>(scaled), bits(1));
  return hn::ShiftRight<13>(hn::Add(scaled, hn::Add(odd, bits(0xfff))));
}

/// The angle of (x, y) over the whole circle; 0 for (0, 0).
HWY_INLINE Float angle_of(Float x, Float y) {
  const Float wide = hn::Abs(x), high = hn::Abs(y);
  const Mask steep = hn::Gt(high, wide);
  const Float ratio = hn::Div(hn::Min(wide, high), at_least(hn::Max(wide, high), 1e-37f));
  Float angle = hn::Atan(tag, ratio);
  angle = select(steep, hn::Sub(number(1.57079633f), angle), angle);
  angle = select(hn::Lt(x, zero()), hn::Sub(number(3.14159265f), angle), angle);
  return hn::CopySign(angle, y);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
