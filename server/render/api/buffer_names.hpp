#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "protocol/result.hpp"

namespace heliograph::render {

/// Every name that a view or a capture may give, whichever of them settings and scene make.
const std::vector<std::string>& buffer_names();

/// Refuses any other, which is the value of the member `path`.
protocol::Result<void> check_buffer_name(std::string_view name, const std::string& path);

}  // namespace heliograph::render
