#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "protocol/result.hpp"

// Checked reading of single JSON values, shared by settings and messages so that errors have the
// same texts. `path` is the path in the error.

namespace heliograph::protocol {

/// Both ends are allowed.
struct NumberRange {
  double minimum;
  double maximum;
};

Result<bool> read_boolean(const nlohmann::json& value, const std::string& path);
/// An integer; 64.0 is one, since JavaScript does not distinguish it from 64.
Result<std::int64_t> read_integer(const nlohmann::json& value, const std::string& path,
                                  NumberRange range);
/// A finite number.
Result<double> read_number(const nlohmann::json& value, const std::string& path, NumberRange range);
Result<std::string> read_text(const nlohmann::json& value, const std::string& path);
/// The index of a string in `choices`.
Result<std::size_t> read_choice(const nlohmann::json& value, const std::string& path,
                                std::span<const std::string_view> choices);

/// The double with the fewest decimal digits that rounds to this float: 0.1f -> 0.1.
double shortest(float value);
/// Shortest decimal text.
std::string number_text(double value);
/// "0 to 100", "at least 0", "at most 5" or an empty string.
std::string range_text(NumberRange range);
/// "a, b or c"
std::string choices_text(std::span<const std::string_view> choices);

}  // namespace heliograph::protocol
