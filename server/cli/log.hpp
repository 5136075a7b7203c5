#pragma once

#include "cli/options.hpp"

namespace heliograph::cli {

/// Writes the log to stderr, as lines of text or as JSON objects.
void set_up_log(const LogOptions& options);

}  // namespace heliograph::cli
