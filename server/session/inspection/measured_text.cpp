#include "session/inspection/measured_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace heliograph::session {
namespace {

using protocol::LengthUnit;

double metres_of(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::m:
      return 1.0;
    case LengthUnit::cm:
      return 0.01;
    case LengthUnit::mm:
      return 0.001;
    case LengthUnit::km:
      return 1000.0;
    case LengthUnit::in:
      return 0.0254;
    case LengthUnit::ft:
      return 0.3048;
  }
  return 1.0;
}

std::string number_text(double value) {
  constexpr int digits = 4, most_decimals = 9;
  const int magnitude =
      value != 0.0 ? static_cast<int>(std::floor(std::log10(std::abs(value)))) : 0;
  const int decimals = std::clamp(digits - 1 - magnitude, 0, most_decimals);
  std::array<char, 400> text{};  // the longest double has 309 digits before the point
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                          std::chars_format::fixed, decimals);
  std::string_view shown(text.data(), static_cast<std::size_t>(end - text.data()));
  if (decimals > 0) {
    while (shown.ends_with('0')) shown.remove_suffix(1);
    if (shown.ends_with('.')) shown.remove_suffix(1);
  }
  return std::string(shown);
}

std::string with_unit(const std::string& number, LengthUnit unit) {
  return number + " " + std::string(protocol::enum_name(unit));
}

}  // namespace

std::string length_text(double metres, LengthUnit unit) {
  return with_unit(number_text(metres / metres_of(unit)), unit);
}

std::string size_text(const glm::vec3& metres, LengthUnit unit) {
  const auto side = [&](float length) {
    return number_text(static_cast<double>(length) / metres_of(unit));
  };
  return with_unit(side(metres.x) + " × " + side(metres.y) + " × " + side(metres.z), unit);
}

std::string angle_text(double degrees) {
  return number_text(degrees) + "°";
}

}  // namespace heliograph::session
