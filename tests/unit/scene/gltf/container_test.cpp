#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <iterator>
#include <random>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

std::string refusal_of_bytes(const Bytes& file) {
  const TemporaryFolder folder;
  return refusal_of(folder.write("scene.glb", file));
}

std::string refusal_of_text(std::string_view text) {
  const TemporaryFolder folder;
  return refusal_of(folder.write("scene.gltf", text));
}

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

void set_u32(Bytes& file, std::size_t offset, std::uint32_t value) {
  std::memcpy(file.data() + offset, &value, sizeof value);
}

TEST(Container, MissingEmptyAndSpecialFilesAreRejected) {
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(refusal_of(folder.path() / "nothing.glb"), "does not exist"));
  EXPECT_TRUE(contains(refusal_of(folder.path()), "not a regular file"));
  EXPECT_TRUE(contains(refusal_of("/dev/zero"), "not a regular file"));
  EXPECT_TRUE(contains(refusal_of_text(""), "empty"));
  ASSERT_EQ(mkfifo((folder.path() / "pipe.glb").c_str(), 0600), 0);
  EXPECT_TRUE(contains(refusal_of(folder.path() / "pipe.glb"), "not a regular file"))
      << "opening a pipe must not block";
}

TEST(Container, ErrorsDoNotRevealAbsolutePaths) {
  const TemporaryFolder folder;
  EXPECT_FALSE(contains(refusal_of(folder.path() / "nothing.glb"), folder.path().string()));
}

TEST(Container, TruncatedGlbIsRejected) {
  const Bytes file = everything().glb();
  ASSERT_EQ(refusal_of_bytes(file), "");
  for (std::size_t size = 0; size < file.size(); size += 7) {
    EXPECT_NE(refusal_of_bytes(Bytes(file.begin(), file.begin() + size)), "") << size;
  }
}

TEST(Container, InvalidGlbHeadersAreRejected) {
  const Bytes good = triangle().glb();
  Bytes file = good;
  file[0] = 'G';
  EXPECT_TRUE(contains(refusal_of_bytes(file), "neither GLB nor JSON"));
  for (const std::uint32_t version : {0u, 1u, 3u, 99u}) {
    file = good;
    set_u32(file, 4, version);
    EXPECT_TRUE(contains(refusal_of_bytes(file), "version"));
  }
  for (const std::uint32_t length : {0u, 11u, 19u, 0xffffffffu}) {
    file = good;
    set_u32(file, 8, length);
    EXPECT_TRUE(contains(refusal_of_bytes(file), "GLB")) << length;
  }
  for (const std::uint32_t length : {0u, 0xfffffff0u, static_cast<std::uint32_t>(good.size())}) {
    file = good;
    set_u32(file, 12, length);
    EXPECT_NE(refusal_of_bytes(file), "") << length;
  }
  file = good;
  set_u32(file, 16, 0x004e4942);
  EXPECT_TRUE(contains(refusal_of_bytes(file), "JSON chunk"));
}

TEST(Container, TextOtherThanGltfIsRejected) {
  EXPECT_TRUE(contains(refusal_of_text("hello"), "neither GLB nor JSON"));
  EXPECT_TRUE(contains(refusal_of_text("[1, 2]"), "neither GLB nor JSON"));
  EXPECT_TRUE(contains(refusal_of_text("{\"name\": \"a package\"}"), "asset is missing"));
  EXPECT_TRUE(contains(refusal_of_text("{\"asset\": {\"version\": \"2.0\"}, }"),
                       "JSON syntax error at byte"));
  EXPECT_TRUE(
      contains(refusal_of_text("{\"asset\": {\"version\": \"2.0\"}, \"scene\": 1e999}"), "number"));
  EXPECT_TRUE(contains(refusal_of_text("{\"asset\": \"\xff\xfe\"}"), "JSON syntax error"));
}

TEST(Container, DeeplyNestedJsonIsRejected) {
  for (const char* bracket : {"[", "{\"a\":"}) {
    std::string text = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": ";
    for (int i = 0; i < 100'000; ++i) text += bracket;
    EXPECT_TRUE(contains(refusal_of_text(text), "nests deeper than 64"));
  }
  // Brackets inside strings are not nesting.
  EXPECT_EQ(refusal_of_text("{\"asset\": {\"version\": \"2.0\"}, \"extras\": \"\\\"" +
                            std::string(1000, '[') + "\"}"),
            "");
}

TEST(Container, ErrorsNameLimits) {
  const GltfBuilder builder = everything();
  ImportLimits limits;
  limits.file_bytes = 100;
  EXPECT_TRUE(contains(refusal_of(builder, limits), "limit on the files of a scene leaves 100"));
  limits = {};
  limits.triangles = 1;
  EXPECT_TRUE(contains(refusal_of(builder, limits), "limit of"));
  limits = {};
  limits.texels = 3;
  EXPECT_TRUE(contains(refusal_of(builder, limits), "limit of 3 texels"));
  limits = {};
  limits.texture_size = 1;
  EXPECT_TRUE(contains(refusal_of(builder, limits), "the limit is 1"));
  limits = {};
  limits.nodes = 2;
  EXPECT_TRUE(contains(refusal_of(builder, limits), "limit of 2"));
  limits = {};
  limits.instances = 0;
  EXPECT_TRUE(contains(refusal_of(builder, limits), "0 instances"));
  limits = {};
  limits.node_depth = 1;
  EXPECT_TRUE(contains(refusal_of(builder, limits), "deeper than 1"));
  limits = {};
  limits.json_values = 10;
  EXPECT_TRUE(contains(refusal_of(builder, limits), "10 values"));
}

TEST(Container, NodeChainOfHundredThousandIsRejected) {
  GltfBuilder builder;
  constexpr int depth = 100'000;
  for (int i = 0; i < depth; ++i) {
    builder.add("nodes", i + 1 < depth ? json{{"children", {i + 1}}} : json::object());
  }
  EXPECT_TRUE(contains(refusal_of(builder), "deeper than 256"));
}

class Confinement : public testing::Test {
 protected:
  Confinement() {
    std::filesystem::create_directory(folder_.path() / "inside");
    folder_.write("secret.bin", Bytes(64, 's'));
    folder_.write("inside/data.bin", Bytes(64, 'd'));
  }

  std::string refusal_of_uri(std::string_view uri) {
    const json document = {{"asset", {{"version", "2.0"}}},
                           {"buffers", {{{"byteLength", 36}, {"uri", uri}}}},
                           {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}}};
    return refusal_of(folder_.write("inside/scene.gltf", document.dump()));
  }

  TemporaryFolder folder_;
};

TEST_F(Confinement, FilesInsideFolderAreRead) {
  EXPECT_EQ(refusal_of_uri("data.bin"), "");
  EXPECT_EQ(refusal_of_uri("./data.bin"), "");
  EXPECT_EQ(refusal_of_uri("d%61ta.bin"), "");
  std::filesystem::create_symlink("data.bin", folder_.path() / "inside/alias.bin");
  EXPECT_EQ(refusal_of_uri("alias.bin"), "") << "a symlink within the folder";
}

TEST_F(Confinement, FilesOutsideFolderAreRejected) {
  const std::string absolute = (folder_.path() / "secret.bin").string();
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("x/../../secret.bin"),
        std::string("%2e%2e/secret.bin"), std::string("%2E%2E%2Fsecret.bin"),
        std::string("..%2fsecret.bin"), absolute, "%2f" + absolute.substr(1), "/../" + absolute,
        std::string("../inside/../secret.bin")}) {
    EXPECT_TRUE(contains(refusal_of_uri(uri), "outside the scene's folder"))
        << uri << ": " << refusal_of_uri(uri);
  }
}

TEST_F(Confinement, SymlinksOutOfFolderAreRejected) {
  std::filesystem::create_symlink("../secret.bin", folder_.path() / "inside/link.bin");
  std::filesystem::create_directory_symlink("..", folder_.path() / "inside/up");
  EXPECT_TRUE(contains(refusal_of_uri("link.bin"), "outside"));
  EXPECT_TRUE(contains(refusal_of_uri("up/secret.bin"), "outside"));
}

TEST_F(Confinement, SpecialFilesAreRejected) {
  ASSERT_EQ(mkfifo((folder_.path() / "inside/pipe").c_str(), 0600), 0);
  EXPECT_TRUE(contains(refusal_of_uri("pipe"), "not a regular file"));
  EXPECT_TRUE(contains(refusal_of_uri("."), "not a regular file"));
  EXPECT_TRUE(contains(refusal_of_uri("missing.bin"), "is missing"));
}

TEST_F(Confinement, OtherUriSchemesAndBrokenEscapesAreRejected) {
  for (const char* uri :
       {"http://example.org/data.bin", "file:///etc/passwd", "FILE:/etc/passwd"}) {
    EXPECT_TRUE(contains(refusal_of_uri(uri), "scheme")) << uri;
  }
  EXPECT_TRUE(contains(refusal_of_uri("data%2"), "escape"));
  EXPECT_TRUE(contains(refusal_of_uri("data%zz.bin"), "escape"));
  EXPECT_TRUE(contains(refusal_of_uri("data.bin%00.png"), "zero byte"));
  EXPECT_TRUE(contains(refusal_of_uri("data:application/octet-stream;base64,@@@@"), "base64"));
  EXPECT_TRUE(contains(refusal_of_uri("data:text/plain,hello"), "base64"));
  EXPECT_TRUE(contains(refusal_of_uri("data:application/octet-stream;base64,AAAA"),
                       "more than the 3 bytes"));
}

// Damage gives a scene or an ImportError; the sanitizers find everything else.
TEST(Container, RandomDamageIsSafe) {
  const Bytes good = everything().glb();
  const TemporaryFolder folder;
  std::mt19937 random(7);
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    Bytes file = good;
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < changes; ++i) {
      file[random() % file.size()] = static_cast<std::uint8_t>(random());
    }
    const std::string refusal = refusal_of(folder.write("scene.glb", file));
    refused += !refusal.empty();
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 3000) << "some changes are harmless";
}

// The same with JSON values: each member in turn gets each of several wrong values.
TEST(Container, WrongJsonValuesAreSafe) {
  const GltfBuilder good = everything();
  const json flat = good.json.flatten();
  const json odd[] = {
      -1, 0,   1,    1.5,     2147483648u,   4294967295u,    1e30,   -1e30,
      "", "x", true, nullptr, json::array(), json::object(), {0, 0}, 18446744073709551615ull};
  const TemporaryFolder folder;
  int refused = 0;
  for (const auto& member : flat.items()) {
    for (const json& value : odd) {
      GltfBuilder damaged = good;
      damaged.json[json::json_pointer(member.key())] = value;
      refused += !refusal_of(folder.write("scene.glb", damaged.glb())).empty();
    }
  }
  EXPECT_GT(refused, static_cast<int>(flat.size()) * 8) << "of " << flat.size() * std::size(odd);
}

TEST(Container, ProgressRisesFromZeroToOne) {
  const TemporaryFolder folder;
  std::vector<float> fractions;
  import_gltf(
      folder.write("scene.glb", everything().glb()), {},
      {.progress = [&](std::string_view, float fraction) { fractions.push_back(fraction); }});
  ASSERT_GE(fractions.size(), 3u);
  EXPECT_EQ(fractions.front(), 0.0f);
  EXPECT_EQ(fractions.back(), 1.0f);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

}  // namespace
}  // namespace heliograph::scene::test
