#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "render/api/renderer.hpp"

namespace heliograph::cli {

/// Renders frames that never converge and gives the median times of their passes.
/// @throws std::runtime_error where the settings are refused
nlohmann::json measure_passes(render::Renderer& renderer, protocol::Settings settings,
                              std::uint32_t frames);

}  // namespace heliograph::cli
