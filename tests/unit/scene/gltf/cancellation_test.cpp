// A load ends soon after it is cancelled, whatever it is doing.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/gltf/geometry/tangents.hpp"
#include "scene/gltf/schema/document_check.hpp"
#include "scene/gltf/schema/json_text.hpp"
#include "scene/import_error.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

std::stop_token stopped() {
  std::stop_source source;
  source.request_stop();
  return source.get_token();
}

TEST(Cancellation, EndsAnImportWhereverItIsRequested) {
  const TemporaryFolder folder;
  const auto path = folder.write("scene.glb", everything().glb());
  // How many reports there are depends on threads: parts that are done together are one. Requested
  // by each but the last, which comes when all is done.
  for (int last = 1;; ++last) {
    std::stop_source source;
    int seen = 0;
    std::string stage;
    const auto request = [&](std::string_view reported, float) {
      stage = reported;
      if (++seen == last) source.request_stop();
    };
    bool cancelled = false;
    try {
      import_gltf(path, {}, {.progress = request, .stop = source.get_token()});
    } catch (const LoadCancelled&) {
      cancelled = true;
    }
    ASSERT_EQ(seen, last) << "nothing is reported afterwards";
    ASSERT_EQ(cancelled, stage != "done") << stage;
    if (!cancelled) {
      EXPECT_GE(last, 3);
      return;
    }
  }
}

TEST(Cancellation, EndsTheReadingOfFiles) {
  const TemporaryFolder folder;
  const RegularFile file(folder.write("data.bin", Bytes(100)), 100, "data.bin");
  EXPECT_EQ(read_all(file).size(), 100u);
  EXPECT_THROW(read_all(file, stopped()), LoadCancelled);
}

TEST(Cancellation, EndsTheParsingOfDocuments) {
  nlohmann::json document = everything().json;
  const std::string text = document.dump();
  ImportLimits limits;
  Warnings warnings;
  EXPECT_EQ(parse_json(text, limits.json_depth, limits.json_values, {}), document);
  EXPECT_THROW(parse_json(text, limits.json_depth, limits.json_values, stopped()), LoadCancelled);
  EXPECT_THROW(check_document(document, limits, warnings, stopped()), LoadCancelled);
}

TEST(Cancellation, EndsTheGenerationOfTangents) {
  const Scene scene = everything().import();
  std::vector<shared::Vertex> vertices = scene.meshes.at(0).vertices;
  std::vector<std::uint32_t> indices = scene.meshes.at(0).indices;
  EXPECT_THROW(generate_tangents(vertices, indices, no_texture_slot(), stopped()), LoadCancelled);
}

}  // namespace
}  // namespace heliograph::scene::test
