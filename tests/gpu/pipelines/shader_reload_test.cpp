#include "gpu/pipelines/shader_reload.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <thread>

#include "gpu/pipelines/shader.hpp"
#include "render/api/renderer.hpp"
#include "render/views/text_overlay.hpp"
#include "shaders/embedded.hpp"
#include "tests/support/engine.hpp"
#include "tests/support/scene_builder.hpp"

namespace heliograph::test {
namespace {

namespace fs = std::filesystem;

/// The folder shaders/ of the sources.
std::optional<fs::path> shader_sources() {
  const char* const folder = std::getenv("HELIOGRAPH_TEST_SHADERS");
  return folder ? std::optional<fs::path>(folder) : std::nullopt;
}

constexpr const char* no_sources = "HELIOGRAPH_TEST_SHADERS does not name the folder of shaders";

/// A copy of the sources that a test may edit.
class ShaderFolder {
 public:
  explicit ShaderFolder(const fs::path& sources) {
    std::string name = (fs::temp_directory_path() / "heliograph_shaders_XXXXXX").string();
    root_ = mkdtemp(name.data());
    fs::copy(sources, path(), fs::copy_options::recursive);
  }
  ~ShaderFolder() { fs::remove_all(root_); }
  ShaderFolder(const ShaderFolder&) = delete;
  ShaderFolder& operator=(const ShaderFolder&) = delete;

  fs::path path() const { return root_ / "shaders"; }

  /// The number of the first line of a file that has the text, from 1.
  int line_of(const fs::path& file, const std::string& text) const {
    std::ifstream in(path() / file);
    std::string line;
    int number = 1;
    while (std::getline(in, line) && line.find(text) == std::string::npos) ++number;
    return number;
  }

  void replace(const fs::path& file, const std::string& before, const std::string& after) const {
    std::ifstream in(path() / file, std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(in), {});
    const std::size_t at = text.find(before);
    ASSERT_NE(at, std::string::npos) << file << " does not contain " << before;
    text.replace(at, before.size(), after);
    // Saved as editors do: written beside and moved over.
    const fs::path beside = root_ / "saving";
    std::ofstream(beside, std::ios::binary) << text;
    fs::rename(beside, path() / file);
  }

 private:
  fs::path root_;
};

/// A renderer of a lit wall, whose shaders come from a folder.
class ReloadingRenderer {
 public:
  explicit ReloadingRenderer(const fs::path& folder)
      : engine_({.device = {}, .validation = true, .cache_folder = {}, .shader_folder = folder}),
        renderer_(engine_) {
    SceneBuilder scene;
    scene.place(scene.add_quad({{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}},
                               surface({0.6f, 0.2f, 0.1f}, 0.4f)));
    renderer_.set_scene(engine_.upload(scene.build(), scene::constant_environment(glm::vec3(1))));
    renderer_.set_size(64, 64);
    renderer_.set_camera(look({0, 0, 4}, {0, 0, 0}));
    renderer_.set_frame_seconds(1.0f / 60.0f);
    seen_ = reload().version();
  }
  ~ReloadingRenderer() { EXPECT_EQ(engine_.validation_messages(), 0u); }

  /// The first frame of an empty history, so that equal shaders make equal bytes.
  std::vector<std::uint8_t> render() {
    renderer_.invalidate_history();
    return renderer_.render().rgba;
  }
  bool needs_frame() const { return renderer_.needs_frame(); }
  render::Renderer& renderer() { return renderer_; }
  std::string error() const { return engine_.shader_error(); }

  /// Until the compiling thread has looked at what was saved since the last wait.
  void wait() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (reload().version() == seen_) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "the folder was not looked at";
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    seen_ = reload().version();
  }

 private:
  gpu::ShaderReload& reload() { return *engine_.parts().shader_reload; }

  render::Engine engine_;
  render::Renderer renderer_;
  std::uint64_t seen_ = 0;
};

class ShaderReloadTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto sources = shader_sources();
    if (!sources) GTEST_SKIP() << no_sources;
    folder_.emplace(*sources);
    view_.emplace(folder_->path());
  }

  std::optional<ShaderFolder> folder_;
  std::optional<ReloadingRenderer> view_;
};

constexpr const char* present = "post/present.comp";
constexpr const char* stored = "vec4(encoded, 1.0)";

TEST(ShaderCompiler, CompilesEveryStageToTheEmbeddedInterface) {
  const auto sources = shader_sources();
  if (!sources) GTEST_SKIP() << no_sources;
  const gpu::ShaderCompiler compiler(*sources);
  std::size_t compared = 0;
  for (const fs::path& file : compiler.stages()) {
    const auto embedded =
        std::find_if(shaders::all.begin(), shaders::all.end(),
                     [&](const auto* shader) { return shader->name == file.filename().string(); });
    ASSERT_NE(embedded, shaders::all.end()) << file;
    const gpu::CompiledShader compiled = compiler.compile(file);
    const gpu::Reflection built = gpu::reflect(**embedded);
    const gpu::Reflection now = gpu::reflect({(*embedded)->name, compiled.words});
    EXPECT_EQ(built.constants_size, now.constants_size) << file;
    EXPECT_EQ(built.local_size.width, now.local_size.width) << file;
    EXPECT_EQ(built.local_size.height, now.local_size.height) << file;
    ASSERT_EQ(built.bindings.size(), now.bindings.size()) << file;
    for (std::size_t i = 0; i < built.bindings.size(); ++i) {
      const gpu::ShaderBinding &a = built.bindings[i], &b = now.bindings[i];
      EXPECT_EQ(std::tie(a.set, a.binding, a.name, a.type, a.count, a.reads, a.writes, a.format),
                std::tie(b.set, b.binding, b.name, b.type, b.count, b.reads, b.writes, b.format))
          << file;
    }
    ++compared;
  }
  EXPECT_EQ(compared, shaders::all.size());
}

TEST(ShaderCompiler, ListsIncludedFiles) {
  const auto sources = shader_sources();
  if (!sources) GTEST_SKIP() << no_sources;
  const gpu::ShaderCompiler compiler(*sources);
  const auto files = compiler.compile(compiler.folder() / present).files;
  EXPECT_TRUE(files.contains(compiler.folder() / present));
  EXPECT_TRUE(files.contains(compiler.folder() / "lib/math/tone_map.glsl"));
  EXPECT_TRUE(files.contains(compiler.folder() / "shared/types.h"))
      << "included by an included one";
}

TEST_F(ShaderReloadTest, UnchangedSourcesRenderLikeTheEmbeddedShaders) {
  const auto from_sources = view_->render();
  EXPECT_EQ(view_->error(), "");
  render::Engine engine(
      {.device = {}, .validation = true, .cache_folder = {}, .host_kernels = false});
  render::Renderer renderer(engine);
  SceneBuilder scene;
  scene.place(scene.add_quad({{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}},
                             surface({0.6f, 0.2f, 0.1f}, 0.4f)));
  renderer.set_scene(engine.upload(scene.build(), scene::constant_environment(glm::vec3(1))));
  renderer.set_size(64, 64);
  renderer.set_camera(look({0, 0, 4}, {0, 0, 0}));
  renderer.set_frame_seconds(1.0f / 60.0f);
  EXPECT_EQ(from_sources, renderer.render().rgba);
}

TEST_F(ShaderReloadTest, SavedStageChangesTheNextFrame) {
  const auto before = view_->render();
  folder_->replace(present, stored, "vec4(1.0 - encoded, 1.0)");
  view_->wait();
  EXPECT_TRUE(view_->needs_frame());
  const auto after = view_->render();
  EXPECT_EQ(view_->error(), "");
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); i += 4) {
    ASSERT_NEAR(before[i] + after[i], 255, 2) << "inverted red of pixel " << i / 4;
  }
  folder_->replace(present, "vec4(1.0 - encoded, 1.0)", stored);
  view_->wait();
  EXPECT_EQ(view_->render(), before);
}

TEST_F(ShaderReloadTest, SavedIncludedFileChangesTheNextFrame) {
  const auto before = view_->render();
  folder_->replace("lib/math/tone_map.glsl", "vec3 srgb_encode(vec3 linear) {",
                   "vec3 srgb_encode(vec3 linear) {\n  return linear;");
  view_->wait();
  EXPECT_EQ(view_->error(), "");
  EXPECT_NE(view_->render(), before);
}

TEST_F(ShaderReloadTest, BrokenShaderKeepsTheLastGoodFrameAndTellsFileAndLine) {
  auto expected = view_->render();
  folder_->replace(present, "  vec3 encoded =", "  vec3 encoded = no_such_function() +");
  view_->wait();
  const std::string place =
      "shaders/post/present.comp:" + std::to_string(folder_->line_of(present, "no_such_function"));
  EXPECT_EQ(view_->error().rfind(place + ": 'no_such_function'", 0), 0u) << view_->error();
  EXPECT_TRUE(view_->needs_frame()) << "the error is to be shown";
  render::draw_text(view_->error(), expected, 64, 64);
  EXPECT_EQ(view_->render(), expected) << "the last good frame with the error over it";

  folder_->replace(present, "no_such_function() +", "");
  view_->wait();
  EXPECT_EQ(view_->error(), "");
  EXPECT_TRUE(view_->needs_frame());
  const auto recovered = view_->render();
  EXPECT_NE(recovered, expected) << "without the text";
}

TEST_F(ShaderReloadTest, ErrorOfAnIncludedFileIsToldOnce) {
  folder_->replace("lib/frame.glsl", "bool outside_frame(", "bool outside_frame(nonsense x,");
  view_->wait();
  const std::string error = view_->error();
  const std::size_t first = error.find("shaders/lib/frame.glsl:");
  ASSERT_NE(first, std::string::npos) << error;
  const std::string line = error.substr(first, error.find('\n', first) - first);
  EXPECT_EQ(error.find(line, first + 1), std::string::npos) << "many stages include it:\n" << error;
}

TEST_F(ShaderReloadTest, ChangedBindingIsAnError) {
  auto expected = view_->render();
  folder_->replace(present, "layout(set = 1, binding = 1, rgba16f) readonly uniform",
                   "layout(set = 1, binding = 1, rgba32f) readonly uniform");
  view_->wait();
  EXPECT_NE(view_->error().find("shaders/post/present.comp:1: set 1 binding 1 \"mean\""),
            std::string::npos)
      << view_->error();
  render::draw_text(view_->error(), expected, 64, 64);
  EXPECT_EQ(view_->render(), expected);
}

TEST(ShaderReload, BrokenFolderStartsWithTheEmbeddedShaders) {
  const auto sources = shader_sources();
  if (!sources) GTEST_SKIP() << no_sources;
  ShaderFolder folder(*sources);
  folder.replace(present, stored, "vec5(encoded, 1.0)");
  ReloadingRenderer view(folder.path());
  EXPECT_NE(view.error(), "");
  folder.replace(present, "vec5(encoded, 1.0)", stored);
  view.wait();
  EXPECT_EQ(view.error(), "");
  EXPECT_FALSE(view.render().empty());
}

TEST(TextOverlay, DrawsLightTextOnADarkBoxAndLeavesTheRest) {
  std::vector<std::uint8_t> rgba(std::size_t{64} * 64 * 4, 100);
  const auto before = rgba;
  render::draw_text("", rgba, 64, 64);
  EXPECT_EQ(rgba, before);
  render::draw_text("I", rgba, 64, 64);
  const auto red = [&](std::size_t x, std::size_t y) { return rgba[(y * 64 + x) * 4]; };
  EXPECT_EQ(red(0, 0), 25) << "the box";
  EXPECT_EQ(red(4 + 2, 4 + 5), 255) << "the stem of the letter";
  EXPECT_EQ(red(14, 0), 100) << "right of the box";
  EXPECT_EQ(red(0, 21), 100) << "below the box";
}

}  // namespace
}  // namespace heliograph::test
