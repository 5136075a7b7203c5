#include "tests/bench/atrous_rate.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/atrous_rate.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "hwy/aligned_allocator.h"
#include "hwy/highway.h"

#ifndef HELIOGRAPH_BENCH_ATROUS_FIELD
#define HELIOGRAPH_BENCH_ATROUS_FIELD
namespace heliograph::bench {

/// Images in planes, with a border that taps may read.
struct Field {
  /// Three of the normal, two of the slope, four of each signal.
  enum Plane { normal, roughness = 3, view_z, slope, value = 7, filtered = 11, planes = 15 };

  Field(int width_, int height_, int border)
      : width(width_), height(height_), pitch(whole_vectors(width_) + 2 * whole_vectors(border)) {
    const auto size = static_cast<std::size_t>(pitch) * (height + 2 * border);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (int i = 0; i < planes; ++i) {
      memory[i] = hwy::AllocateAligned<float>(size);
      const float least = i == view_z ? 3.0f : 0.1f, range = i < value ? 0.01f : 1.0f;
      for (std::size_t k = 0; k < size; ++k) memory[i][k] = least + range * unit(random);
    }
    first = border * pitch + whole_vectors(border);
  }
  static int whole_vectors(int columns) { return (columns + 15) / 16 * 16; }
  float* row(int plane, int y) const { return memory[plane].get() + first + y * pitch; }

  int width, height, pitch, first;
  hwy::AlignedFreeUniquePtr<float[]> memory[planes];
};

}  // namespace heliograph::bench
#endif

HWY_BEFORE_NAMESPACE();
namespace heliograph::bench::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Four taps, `apart` floats from each other, of one row.
template <bool visibility>
void filter_row(const Field& field, int y, int step, bool across) {
  using D = hn::ScalableTag<float>;
  using V = hn::Vec<D>;
  const D d;
  const hn::RebindToUnsigned<D> du;
  const auto set = [&](float value) HWY_ATTR { return hn::Set(d, value); };
  const int apart = across ? step : step * field.pitch;
  constexpr int signals = visibility ? 2 : 1;
  const float* in[Field::filtered];
  for (int i = 0; i < Field::filtered; ++i) in[i] = field.row(i, y);
  const float* const slopes = in[Field::slope + (across ? 0 : 1)];
  for (int x = 0; x < field.width; x += static_cast<int>(hn::Lanes(d))) {
    const auto load = [&](int plane, int at) HWY_ATTR { return hn::LoadU(d, in[plane] + at); };
    const V nx = load(0, x) * set(185.0f), ny = load(1, x) * set(185.0f);
    const V nz = load(2, x) * set(185.0f), rough = load(Field::roughness, x);
    const V z = load(Field::view_z, x), slope = hn::LoadU(d, slopes + x);
    const V inv_allowed = hn::ApproximateReciprocal(hn::Abs(slope) + z * set(0.001f));
    const V curve = slope * inv_allowed * hn::ApproximateReciprocal(z);
    const V depth = z * inv_allowed;
    const V reach = hn::ApproximateReciprocal(hn::MulAdd(rough, set(0.14f), set(0.014f)));
    V value[4], sum[4], bright[2], inv_sigma[2], total[2] = {set(1.0f), set(1.0f)};
    for (int i = 0; i < 4; ++i) sum[i] = value[i] = load(Field::value + i, x);
    const auto luminance = [&](V r, V g, V b) HWY_ATTR {
      return hn::MulAdd(r, set(0.2126f), hn::MulAdd(g, set(0.7152f), b * set(0.0722f)));
    };
    for (int i = 0; i < signals; ++i) {
      bright[i] = visibility ? value[i] : luminance(value[0], value[1], value[2]);
      const V noise = hn::Sqrt(value[visibility ? 2 + i : 3]);
      inv_sigma[i] = hn::ApproximateReciprocal(hn::MulAdd(noise, set(2.8f), set(1e-3f)));
    }
    for (int tap = -2; tap <= 2; ++tap) {
      if (tap == 0) continue;
      const int at = x + tap * apart;
      const V near = set(1.0f / static_cast<float>(std::abs(tap) * step));
      const V scale = hn::NegMulAdd(set(tap < 0 ? -1.0f : 1.0f), curve, inv_allowed * near);
      const V there = load(Field::view_z, at);
      V exponent = set(std::abs(tap) == 1 ? 453.4f : 451.4f);
      exponent = hn::MulAdd(nx, load(0, at), exponent);
      exponent = hn::MulAdd(ny, load(1, at), exponent);
      exponent = hn::MulAdd(nz, load(2, at), exponent);
      exponent = exponent - hn::Abs(hn::MulSub(there, scale, depth * near));
      V q[4];
      for (int i = 0; i < 4; ++i) q[i] = load(Field::value + i, at);
      const auto valid = hn::Gt(there, hn::Zero(d));
      const auto weight = [&](V apart_by, V inv) HWY_ATTR {
        const V e = hn::Max(hn::NegMulAdd(hn::Abs(apart_by), inv, exponent), set(512.0f));
        return hn::IfThenElseZero(valid, hn::BitCast(d, hn::ShiftLeft<9>(hn::BitCast(du, e))));
      };
      if constexpr (visibility) {
        for (int i = 0; i < 2; ++i) {
          const V w = weight(q[i] - bright[i], inv_sigma[i]);
          sum[i] = hn::MulAdd(w, q[i], sum[i]);
          sum[2 + i] = hn::MulAdd(w * w, q[2 + i], sum[2 + i]);
          total[i] = total[i] + w;
        }
      } else {
        const V rougher = hn::Abs(load(Field::roughness, at) - rough);
        exponent = hn::NegMulAdd(rougher, reach, exponent);
        const V w = weight(luminance(q[0], q[1], q[2]) - bright[0], inv_sigma[0]);
        for (int i = 0; i < 3; ++i) sum[i] = hn::MulAdd(w, q[i], sum[i]);
        sum[3] = hn::MulAdd(w * w, q[3], sum[3]);
        total[0] = total[0] + w;
      }
    }
    for (int i = 0; i < 4; ++i) {
      const bool is_variance = visibility ? i >= 2 : i == 3;
      const V by = set(1.0f) / total[visibility ? i % 2 : 0];
      hn::StoreU(sum[i] * (is_variance ? by * by : by), d, field.row(Field::filtered + i, y) + x);
    }
  }
}

void filter_field_row(const Field& field, int y, int step, bool across, bool visibility) {
  visibility ? filter_row<true>(field, y, step, across) : filter_row<false>(field, y, step, across);
}

}  // namespace heliograph::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::bench {

HWY_EXPORT(filter_field_row);

double atrous_milliseconds(bool visibility, std::uint32_t width, std::uint32_t height, int step) {
  constexpr int runs = 24, band = 8;
  const Field field(static_cast<int>(width), static_cast<int>(height), 2 * step);
  std::vector<double> times[2];
  for (int i = 0; i < 2 * runs; ++i) {
    const bool across = i % 2 == 0;
    const auto start = std::chrono::steady_clock::now();
    tbb::parallel_for(0, (field.height + band - 1) / band, [&](int index) {
      for (int y = index * band; y < std::min((index + 1) * band, field.height); ++y) {
        HWY_DYNAMIC_DISPATCH(filter_field_row)(field, y, step, across, visibility);
      }
    });
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    times[i % 2].push_back(time.count());
  }
  const auto median = [](std::vector<double>& of) {
    std::nth_element(of.begin(), of.begin() + runs / 2, of.end());
    return of[runs / 2];
  };
  return 0.5 * (median(times[0]) + median(times[1]));
}

}  // namespace heliograph::bench
#endif
