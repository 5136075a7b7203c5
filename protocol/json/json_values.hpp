#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "protocol/result.hpp"

// Checked reading of single JSON values, shared by settings and messages so that the same mistake
// gets the same words everywhere. `path` is what the error names.

namespace heliograph::protocol {

/// Both ends count.
struct NumberRange {
  double minimum;
  double maximum;
};

Result<bool> read_boolean(const nlohmann::json& value, const std::string& path);
/// A whole number; 64.0 is one, as JavaScript does not tell it from 64.
Result<std::int64_t> read_integer(const nlohmann::json& value, const std::string& path,
                                  NumberRange range);
/// A finite number.
Result<double> read_number(const nlohmann::json& value, const std::string& path, NumberRange range);
Result<std::string> read_text(const nlohmann::json& value, const std::string& path);
/// The index of a text among `choices`.
Result<std::size_t> read_choice(const nlohmann::json& value, const std::string& path,
                                std::span<const std::string_view> choices);

/// The double with the fewest decimal digits that is still this float: 0.1f -> 0.1.
double shortest(float value);
/// Shortest decimal text.
std::string number_text(double value);
/// "0 to 100", "at least 0", "at most 5" or nothing.
std::string range_text(NumberRange range);
/// "a, b or c"
std::string choices_text(std::span<const std::string_view> choices);

}  // namespace heliograph::protocol
