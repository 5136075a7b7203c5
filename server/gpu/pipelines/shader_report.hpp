#pragma once

#include <string>
#include <vector>

namespace heliograph::gpu {

/// What came of shader files that had changed.
struct ShaderReport {
  std::string error;                  // a line per error; empty: everything compiled
  std::vector<std::string> reloaded;  // stages whose code differs from before, by file name
};

}  // namespace heliograph::gpu
