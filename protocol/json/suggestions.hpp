#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace heliograph::protocol {

/// "; did you mean camera.set?" with the candidate nearest to a mistyped name; empty if none is
/// near enough.
std::string suggestion(std::string_view name, const std::vector<std::string_view>& candidates);

}  // namespace heliograph::protocol
