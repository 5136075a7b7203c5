#pragma once

#include "cli/options.hpp"

namespace heliograph::cli {

// One function per command; each returns the process's exit code.
// @throws std::exception with one line for the user

int run(const ServeOptions& options);
int run(const RenderOptions& options);
int run(const CompareOptions& options);
int run(const ExportOptions& options);
int run(const DevicesOptions& options);
int run(const SchemaOptions& options);
int run(const HealthOptions& options);
int run(const McpOptions& options);
int run(const ImportOptions& options);
inline int run(const Finished& finished) {
  return finished.exit_code;
}

}  // namespace heliograph::cli
