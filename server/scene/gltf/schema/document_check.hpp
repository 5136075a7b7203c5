#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <stop_token>
#include <string>
#include <vector>

#include "scene/import_limits.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// A document that has passed the check.
struct CheckedDocument {
  /// What tinygltf parses: the members that the table lists, no others. Whole numbers are written
  /// as such, numbers within their ranges, and each address as the place of its owner.
  std::string text;
  std::map<std::string, std::string, std::less<>> uris;  // by place: "buffers[0]"
  std::vector<std::uint64_t> buffer_lengths;
  std::vector<bool> buffers_with_data;  // others are placeholders of compressed views, or unused
};

/// Checks every member of a document against the table of `schema.hpp`. An error names the place:
/// "nodes[3].mesh: 7 is not an index into 2 meshes". Takes the addresses out of `document`.
/// @throws ImportError, LoadCancelled
CheckedDocument check_document(nlohmann::json& document, const ImportLimits& limits,
                               Warnings& warnings, const std::stop_token& stop);

}  // namespace heliograph::scene
