#include <chrono>

#include "cli/commands.hpp"
#include "session/library/import_helper.hpp"

namespace heliograph::cli {

int run(const ImportOptions& options) {
  return session::run_import_helper(options.limits, std::chrono::seconds(options.seconds));
}

}  // namespace heliograph::cli
