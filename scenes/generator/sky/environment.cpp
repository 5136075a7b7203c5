#include "scenes/generator/sky/environment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string>

#include "scenes/generator/geometry/transforms.hpp"
#include "scenes/generator/textures/noise.hpp"

namespace heliograph::scenes {
namespace {

// `dither` in [-0.5, 0.5) hides the coarse steps of the mantissas in smooth skies.
std::array<std::uint8_t, 4> to_rgbe(glm::vec3 color, glm::vec3 dither) {
  const float largest = std::max({color.x, color.y, color.z});
  if (largest < 1e-32f) return {0, 0, 0, 0};
  int exponent = 0;
  const float scale = std::frexp(largest, &exponent) * 256.0f / largest;
  const glm::vec3 mantissa = glm::clamp(glm::floor(color * scale + dither + 0.5f), 0.0f, 255.0f);
  return {std::uint8_t(mantissa.x), std::uint8_t(mantissa.y), std::uint8_t(mantissa.z),
          std::uint8_t(exponent + 128)};
}

// One component of a scanline: runs of at least 4 equal bytes as (128 + length, value), the rest
// as (length, values...).
void encode_runs(const std::vector<std::uint8_t>& bytes, std::vector<std::uint8_t>& out) {
  constexpr std::size_t shortest_run = 4;
  const auto run_length = [&](std::size_t at) {
    std::size_t end = at;
    while (end < bytes.size() && end - at < 127 && bytes[end] == bytes[at]) ++end;
    return end - at;
  };
  std::size_t at = 0;
  while (at < bytes.size()) {
    const std::size_t run = run_length(at);
    if (run >= shortest_run) {
      out.push_back(std::uint8_t(128 + run));
      out.push_back(bytes[at]);
      at += run;
      continue;
    }
    std::size_t end = at;
    while (end < bytes.size() && end - at < 128 && run_length(end) < shortest_run) ++end;
    out.push_back(std::uint8_t(end - at));
    out.insert(out.end(), bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(end));
    at = end;
  }
}

}  // namespace

glm::vec3 Environment::direction(int x, int y) const {
  const float azimuth = ((float(x) + 0.5f) / float(width) - 0.5f) * 2.0f * pi;
  const float polar = (float(y) + 0.5f) / float(height) * pi;
  return {std::sin(polar) * std::cos(azimuth), std::cos(polar),
          std::sin(polar) * std::sin(azimuth)};
}

glm::vec3 Environment::horizontal_irradiance() const {
  glm::vec3 sum(0.0f);
  for (int y = 0; y < height / 2; ++y) {
    const float polar = (float(y) + 0.5f) / float(height) * pi;
    const float solid_angle = 2.0f * pi / float(width) * pi / float(height) * std::sin(polar);
    glm::vec3 row(0.0f);
    for (int x = 0; x < width; ++x) row += at(x, y);
    sum += row * solid_angle * std::cos(polar);
  }
  return sum;
}

std::vector<std::uint8_t> encode_hdr(const Environment& environment) {
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
                             std::to_string(environment.height) + " +X " +
                             std::to_string(environment.width) + "\n";
  std::vector<std::uint8_t> file(header.begin(), header.end());
  const auto width = std::size_t(environment.width);
  std::array<std::vector<std::uint8_t>, 4> planes;
  for (auto& plane : planes) plane.resize(width);
  for (int y = 0; y < environment.height; ++y) {
    for (int x = 0; x < environment.width; ++x) {
      const glm::vec3 dither(hash_unit(x, y, 1), hash_unit(x, y, 2), hash_unit(x, y, 3));
      const auto rgbe = to_rgbe(environment.at(x, y), 0.98f * (dither - 0.5f));
      for (std::size_t c = 0; c < 4; ++c) planes[c][std::size_t(x)] = rgbe[c];
    }
    file.insert(file.end(), {2, 2, std::uint8_t(width >> 8), std::uint8_t(width & 255)});
    for (const auto& plane : planes) encode_runs(plane, file);
  }
  return file;
}

}  // namespace heliograph::scenes
