#pragma once

#include "cli/options.hpp"

namespace heliograph::cli {

/// Sends the log to stderr, as lines for people or as JSON objects.
void set_up_log(const LogOptions& options);

}  // namespace heliograph::cli
