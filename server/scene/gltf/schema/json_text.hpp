#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <stop_token>
#include <string_view>

namespace heliograph::scene {

/// Parses a glTF document after a pass over the bytes has checked that it nests no deeper than
/// `max_depth` and has at most `max_values` values.
/// @throws ImportError, LoadCancelled
nlohmann::json parse_json(std::string_view text, std::uint32_t max_depth, std::uint64_t max_values,
                          const std::stop_token& stop);

}  // namespace heliograph::scene
