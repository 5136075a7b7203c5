#pragma once

// A field of surfaces with a noisy signal, filtered by shaders and by a reference in double.

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/passes/denoise/atrous.hpp"
#include "render/passes/denoise/denoise_constants.hpp"
#include "render/passes/formats.hpp"
#include "shaders/embedded.hpp"
#include "tests/gpu/denoise/packed_input.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {

inline constexpr int field_width = 37, field_height = 23;
inline constexpr VkExtent2D field_extent{field_width, field_height};
inline constexpr std::size_t field_pixels = field_width * field_height;

/// What is filtered: a slanted floor, a wall and a strip of background, with random signal and
/// normals.
struct FilterInput {
  std::vector<glm::vec4> guide{field_pixels}, signal{field_pixels};
  std::vector<glm::vec2> slope{field_pixels};

  explicit FilterInput(std::uint32_t seed) {
    RandomInputs random(seed);
    for (int y = 0; y < field_height; ++y) {
      for (int x = 0; x < field_width; ++x) {
        const auto i = static_cast<std::size_t>(y * field_width + x);
        const bool floor = y > 11;
        const glm::vec3 base = floor ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
        const glm::vec3 normal = glm::normalize(base + 0.05f * random.unit_vector());
        const float z = floor ? 4.0f + 0.2f * static_cast<float>(22 - y) : 9.0f;
        slope[i] = floor ? glm::vec2(0.0f, -0.2f) : glm::vec2(0.0f);
        guide[i] = glm::vec4(normal * (1.0f + stored_roughness(random.uniform(0.1f, 0.5f))),
                             x == 30 ? 0.0f : z);
        signal[i] = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 0.2f),
                     random.uniform(0, 0.2f)};
      }
    }
  }
};

/// How a reference weighs: as SVGF states it, or as shaders/lib/denoise/edge_stopping.glsl does,
/// with a power of the cosine to first order and an exponential by a float's bits.
enum class Weights { stated, cheap };

inline double cheap_exponential(double exponent) {
  const double octaves = std::max(exponent / std::log(2.0) + 127.0, 0.0);
  const double whole = std::floor(octaves);
  return std::ldexp(1.0 + octaves - whole, static_cast<int>(whole) - 127);
}

/// Reference implementation in double: SVGF eq. 1-5.
class AtrousReference {
 public:
  AtrousReference(const FilterInput& in, const shared::AtrousConstants& constants, bool specular,
                  float footprint, Weights weights)
      : in_(in),
        c_(constants),
        specular_(specular),
        footprint_(footprint),
        cheap_(weights == Weights::cheap) {}

  std::vector<glm::dvec4> run() const {
    std::vector<glm::dvec4> result(field_pixels);
    for (int y = 0; y < field_height; ++y) {
      for (int x = 0; x < field_width; ++x) result[at(x, y)] = filter(x, y);
    }
    return result;
  }

 private:
  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * field_width + x); }
  glm::dvec2 bright(std::size_t i) const {
    const glm::dvec4 s(in_.signal[i]);
    if (!specular_) return {s.x, s.y};
    return glm::dvec2(0.2126 * s.x + 0.7152 * s.y + 0.0722 * s.z);
  }
  glm::dvec2 variance(std::size_t i) const {
    const glm::dvec4 s(in_.signal[i]);
    return specular_ ? glm::dvec2(s.w) : glm::dvec2(s.z, s.w);
  }
  glm::dvec2 noise(int x, int y) const {
    if (!(c_.flags & shared::atrous_variance_prefilter)) return glm::sqrt(variance(at(x, y)));
    glm::dvec2 sum(0.0);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int qx = std::clamp(x + dx, 0, field_width - 1),
                  qy = std::clamp(y + dy, 0, field_height - 1);
        sum += (2 - std::abs(dx)) * (2 - std::abs(dy)) / 16.0 * variance(at(qx, qy));
      }
    }
    return glm::sqrt(sum);
  }

  glm::dvec4 filter(int x, int y) const {
    constexpr double kernel[] = {1.0, 2.0 / 3.0, 1.0 / 6.0};
    const std::size_t p = at(x, y);
    const glm::dvec4 guide_p(in_.guide[p]);
    if (guide_p.w <= 0.0) return glm::dvec4(in_.signal[p]);
    const double size_p = glm::length(glm::dvec3(guide_p));
    const glm::dvec2 sigma = noise(x, y);
    const int step = c_.start_threshold < 0.0f ? 2 << c_.level : 1 << c_.level;
    glm::dvec4 sum(0.0);
    glm::dvec2 total(0.0);
    for (int j = -c_.rows; j <= c_.rows; ++j) {
      for (int i = -c_.columns; i <= c_.columns; ++i) {
        const int qx = x + i * step, qy = y + j * step;
        if (qx < 0 || qy < 0 || qx >= field_width || qy >= field_height) continue;
        const std::size_t q = at(qx, qy);
        const glm::dvec4 guide_q(in_.guide[q]);
        if (guide_q.w <= 0.0) continue;
        const glm::dvec2 offset(i * step, j * step);
        const double size_q = glm::length(glm::dvec3(guide_q));
        const double rise = glm::dot(glm::dvec2(in_.slope[p]), offset);
        const double away = std::abs(guide_q.w * (1.0 - rise / guide_p.w) - guide_p.w);
        const double allowed =
            c_.depth_sigma * (std::abs(rise) + 0.5 * footprint_ * guide_p.w * glm::length(offset));
        const double e_z = i == 0 && j == 0 ? 0.0 : -away / allowed;
        const double cosine =
            glm::dot(glm::dvec3(guide_p), glm::dvec3(guide_q)) / (size_p * size_q);
        const double e_n = double(c_.normal_power) *
                           (cheap_ ? cosine - 1.0 : std::log(std::clamp(cosine, 1e-6, 1.0)));
        const double e_r =
            specular_ ? -std::abs(size_p - size_q) / (0.02 + 0.2 * (size_p - 1.0)) : 0.0;
        const glm::dvec2 e_l = -glm::abs(bright(p) - bright(q)) /
                               (double(c_.luminance_sigma) * sigma + (specular_ ? 1e-4 : 1e-3));
        const glm::dvec2 exponent =
            std::log(kernel[std::abs(i)] * kernel[std::abs(j)]) + e_z + e_n + e_r + e_l;
        const glm::dvec2 w =
            cheap_ ? glm::dvec2(cheap_exponential(exponent.x), cheap_exponential(exponent.y))
                   : glm::exp(exponent);
        const glm::dvec4 s(in_.signal[q]);
        sum += specular_ ? glm::dvec4(w.x * s.x, w.x * s.y, w.x * s.z, w.x * w.x * s.w)
                         : glm::dvec4(w.x * s.x, w.y * s.y, w.x * w.x * s.z, w.y * w.y * s.w);
        total += w;
      }
    }
    return specular_ ? sum / glm::dvec4(total.x, total.x, total.x, total.x * total.x)
                     : sum / glm::dvec4(total, total * total);
  }

  const FilterInput& in_;
  shared::AtrousConstants c_;
  bool specular_;
  double footprint_;
  bool cheap_;
};

/// A blur from the level of `given` on.
inline render::AtrousConfig filter_config(const FrameRig& rig, const shared::AtrousConstants& given,
                                          bool specular, int iterations,
                                          protocol::BlurKernel kernel) {
  const auto constants = [given](const render::KernelShape& shape) {
    shared::AtrousConstants made = given;
    made.level = given.level + shape.level;
    made.columns = shape.columns;
    made.rows = shape.rows;
    return made;
  };
  const auto program = [&rig](const gpu::ShaderBinary& shader) {
    return rig.inputs().program(shader);
  };
  const render::AtrousHalfPrograms halves =
      specular ? render::AtrousHalfPrograms{program(shaders::specular_atrous_half_first),
                                            program(shaders::specular_atrous_half),
                                            program(shaders::specular_atrous_half_last),
                                            program(shaders::specular_atrous_half_result)}
               : render::AtrousHalfPrograms{program(shaders::visibility_atrous_half_first),
                                            program(shaders::visibility_atrous_half),
                                            program(shaders::visibility_atrous_half_last),
                                            program(shaders::visibility_atrous_half_result)};
  return {.name = specular ? "specular.atrous" : "visibility.atrous",
          .buffers = specular ? render::specular_atrous_buffers : render::visibility_atrous_buffers,
          .program = program(specular ? shaders::specular_atrous : shaders::visibility_atrous),
          .half_programs = halves,
          .kernel = render::kernels::specular_atrous,
          .halves_kernel = render::kernels::specular_atrous_halves,
          .iterations = iterations,
          .shape = kernel,
          .constants = constants};
}

/// A rig whose blur has `iterations` levels from that of `constants`.
struct FilterRig {
  /// `fed_back`: the iteration whose result is kept for the next frame, if any.
  FilterRig(const FilterInput& in, const shared::AtrousConstants& given, bool specular,
            int iterations = 1, protocol::BlurKernel kernel = protocol::BlurKernel::full,
            std::optional<int> fed_back = std::nullopt)
      : rig(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), {.extent = field_extent}),
        input{rig.input("guide", render::formats::four_floats, in.guide),
              rig.input("slope", VK_FORMAT_R32G32_SFLOAT, in.slope),
              rig.input("signal", render::formats::four_floats, in.signal),
              packed_input(rig, in.guide, in.slope)} {
    std::optional<render::Feedback> feedback;
    if (fed_back) feedback = {*fed_back, [this](gpu::ImageRef image) { kept = image; }};
    rig.plan().use_host_kernels(false);  // atrous_kernel_test.cpp compares the host kernel
    filtered = render::blur(rig.plan(), rig.inputs(), input,
                            filter_config(rig, given, specular, iterations, kernel), feedback);
  }
  render::FloatImage run() {
    rig.run();
    return rig.read(filtered);
  }

  FrameRig rig;
  render::AtrousInput input;
  gpu::ImageRef filtered;
  gpu::ImageRef kept;  // what is fed back
};

inline shared::AtrousConstants plain_constants() {
  shared::AtrousConstants constants{};
  constants.luminance_sigma = 4.0f;
  constants.normal_power = 32.0f;
  constants.depth_sigma = 1.0f;
  constants.start_threshold = 2.0f;
  constants.flags = shared::atrous_variance_prefilter;
  constants.pixels_per_texel = 1;
  return constants;
}

}  // namespace heliograph::test
