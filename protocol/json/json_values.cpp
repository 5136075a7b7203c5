#include "protocol/json/json_values.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "protocol/json/suggestions.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

// Beyond this, a double no longer tells neighbouring integers apart (2^53).
constexpr double exact_integers = 9007199254740992.0;

/// As short as tells the value from its neighbours.
template <class Float, class... Format>
std::string decimal(Float value, Format... format) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value, format...);
  return std::string(digits, end.ptr);
}

}  // namespace

Result<bool> read_boolean(const json& value, const std::string& path) {
  if (!value.is_boolean()) return error::invalid(path, "must be true or false");
  return value.get<bool>();
}

Result<std::int64_t> read_integer(const json& value, const std::string& path, NumberRange range) {
  const Result<double> number = read_number(value, path, range);
  if (!number) {
    if (value.is_number()) return number.error();
    return error::invalid(path, "must be an integer", range_text(range));
  }
  if (*number != std::trunc(*number)) {
    return error::invalid(path, "must be an integer", range_text(range));
  }
  if (std::abs(*number) > exact_integers) {
    return error::invalid(path, "is out of range", range_text({-exact_integers, exact_integers}));
  }
  return static_cast<std::int64_t>(*number);
}

Result<double> read_number(const json& value, const std::string& path, NumberRange range) {
  if (!value.is_number()) return error::invalid(path, "must be a number", range_text(range));
  const double number = value.get<double>();
  if (!std::isfinite(number)) {
    return error::invalid(path, "must be a finite number", range_text(range));
  }
  if (number < range.minimum || number > range.maximum) {
    return error::invalid(path, "is out of range", range_text(range));
  }
  return number;
}

Result<std::string> read_text(const json& value, const std::string& path) {
  if (!value.is_string()) return error::invalid(path, "must be a string");
  return value.get<std::string>();
}

Result<std::size_t> read_choice(const json& value, const std::string& path,
                                std::span<const std::string_view> choices) {
  if (!value.is_string()) return error::invalid(path, "must be a string", choices_text(choices));
  const std::string& name = value.get_ref<const std::string&>();
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i] == name) return i;
  }
  return error::invalid(path, "unknown value" + suggestion(name, {choices.begin(), choices.end()}),
                        choices_text(choices));
}

double shortest(float value) {
  if (!std::isfinite(value)) return value;
  const std::string digits = decimal(value);
  double result = value;
  std::from_chars(digits.data(), digits.data() + digits.size(), result);
  return result;
}

std::string number_text(double value) {
  const double size = std::abs(value);
  const bool plain = size == 0.0 || (size >= 1e-4 && size < 1e7);
  if (plain) return decimal(value, std::chars_format::fixed);
  std::string text = decimal(value);
  // 1e+09 and 1e-06 as people write them
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  std::size_t digits = exponent + 1;
  if (text[digits] == '+') text.erase(digits, 1);
  if (text[digits] == '-') ++digits;
  text.erase(digits, std::min(text.find_first_not_of('0', digits), text.size()) - digits);
  return text;
}

std::string range_text(NumberRange range) {
  // The range of float itself is not a useful limit.
  constexpr double widest = std::numeric_limits<float>::max();
  const bool from = range.minimum > -widest;
  const bool to = range.maximum < widest;
  if (from && to) return number_text(range.minimum) + " to " + number_text(range.maximum);
  if (from) return "at least " + number_text(range.minimum);
  if (to) return "at most " + number_text(range.maximum);
  return {};
}

std::string choices_text(std::span<const std::string_view> choices) {
  std::string text;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (i > 0) text += i + 1 == choices.size() ? " or " : ", ";
    text += choices[i];
  }
  return text;
}

}  // namespace heliograph::protocol
