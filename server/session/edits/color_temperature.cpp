#include "session/edits/color_temperature.hpp"

#include <algorithm>

namespace heliograph::session {
namespace {

/// Coefficients of the cube, the square, the first power and 1.
float cubic(const glm::vec4& coefficients, float x) {
  return ((coefficients.x * x + coefficients.y) * x + coefficients.z) * x + coefficients.w;
}

glm::vec2 planckian_chromaticity(float kelvin) {
  const bool warm = kelvin < 4000.0f;
  const glm::vec4 of_x = warm ? glm::vec4(-0.2661239f, -0.2343589f, 0.8776956f, 0.179910f)
                              : glm::vec4(-3.0258469f, 2.1070379f, 0.2226347f, 0.240390f);
  const float x = cubic(of_x, 1000.0f / kelvin);
  glm::vec4 of_y(3.0817580f, -5.87338670f, 3.75112997f, -0.37001483f);
  if (warm) of_y = {-0.9549476f, -1.37418593f, 2.09137015f, -0.16748867f};
  if (kelvin < 2222.0f) of_y = {-1.1063814f, -1.34811020f, 2.18555832f, -0.20219683f};
  return {x, cubic(of_y, x)};
}

}  // namespace

glm::vec3 black_body_color(float kelvin) {
  const glm::vec2 xy = planckian_chromaticity(kelvin);
  const glm::vec3 xyz(xy.x / xy.y, 1.0f, (1.0f - xy.x - xy.y) / xy.y);
  // CIE XYZ to linear sRGB (IEC 61966-2-1).
  const glm::vec3 rgb(glm::dot(glm::vec3(3.2404542f, -1.5371385f, -0.4985314f), xyz),
                      glm::dot(glm::vec3(-0.9692660f, 1.8760108f, 0.0415560f), xyz),
                      glm::dot(glm::vec3(0.0556434f, -0.2040259f, 1.0572252f), xyz));
  return glm::max(rgb, glm::vec3(0.0f)) / std::max({rgb.x, rgb.y, rgb.z});
}

}  // namespace heliograph::session
