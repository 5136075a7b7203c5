#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "scene/import_limits.hpp"

namespace heliograph::session {

/// What the server sends its helper beside a file and a pipe for the answer; the name follows.
enum class ImportKind : char { scene = 's', environment = 'e', image = 'i' };

/// How the process ended that imported a file, as the helper tells it.
struct ImportEnd {
  std::int32_t error = 0;   // errno where it did not start
  std::int32_t signal = 0;  // that ended it
  std::int32_t late = 0;    // seconds after which it was given up
};

/// Of the answer of one import.
inline constexpr std::size_t most_import_answer = 4096;

/// The process behind ImportProcess: for each file that comes through the socket at its standard
/// input it makes a process that gives up all rights, imports the file and writes the answer, in no
/// more than `time`. Returns when the server has ended.
int run_import_helper(const scene::ImportLimits& limits, std::chrono::seconds time);

}  // namespace heliograph::session
