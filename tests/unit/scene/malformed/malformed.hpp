#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {

/// Cost of an import.
struct ImportCost {
  double seconds = 0.0;
  std::optional<std::uint64_t> bytes;  // peak resident memory above that at the start
};

/// Imports damaged files. Each must be rejected with one line that says where and why, within
/// bounds of time and memory.
class Malformed : public testing::Test {
 protected:
  /// `place`: what the error must name, e.g. "nodes[2].mesh".
  void expect_refused(const std::string& what, const GltfBuilder& document, std::string_view place);
  void expect_refused(const std::string& what, const Bytes& file, std::string_view place,
                      const char* name = "scene.glb");
  /// For damage that the importer tolerates.
  void expect_loaded(const std::string& what, const GltfBuilder& document);
  /// The import may succeed or fail, within the bounds.
  void expect_bounded(const std::string& what, const GltfBuilder& document);

  const std::filesystem::path& folder() const { return folder_.path(); }
  const TemporaryFolder& files() const { return folder_; }

  void TearDown() override;

 private:
  std::string import(const std::string& what, const std::filesystem::path& path);

  TemporaryFolder folder_;
  int count_ = 0;
  ImportCost worst_;
};

/// "/nodes/0/children/2" -> "nodes[0].children": how errors name a member of the document.
std::string named_in_errors(const std::string& json_pointer);

}  // namespace heliograph::scene::test
