#include "session/library/scene_catalogue.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "scene/studio.hpp"
#include "session/library/environment_source.hpp"
#include "tests/support/temporary_folder.hpp"

namespace heliograph::session {
namespace {

using heliograph::test::TemporaryFolder;

std::vector<std::string> names(const SceneCatalogue& catalogue) {
  std::vector<std::string> result;
  for (const CatalogueEntry& entry : catalogue.list()) result.push_back(entry.name);
  return result;
}

TEST(SceneCatalogue, ListsScenesOfAllFoldersByName) {
  TemporaryFolder folder;
  folder.write("helmet.glb", "12345");
  folder.write("models/chair/chair.gltf");
  folder.write("models/chair/chair.bin");
  folder.write("readme.txt");
  const SceneCatalogue catalogue({folder.path()});
  EXPECT_EQ(names(catalogue), (std::vector<std::string>{"helmet", "models/chair/chair"}));
  EXPECT_EQ(catalogue.list().front().bytes, 5u);
}

TEST(SceneCatalogue, FindsFilesThatAreAddedLater) {
  TemporaryFolder folder;
  const SceneCatalogue catalogue({folder.path()});
  EXPECT_TRUE(catalogue.list().empty());
  folder.write("new.glb");
  EXPECT_TRUE(catalogue.find("new"));
}

TEST(SceneCatalogue, EarlierRootsAndGlbTakePrecedence) {
  TemporaryFolder first;
  TemporaryFolder second;
  first.write("a.gltf");
  first.write("a.glb");
  second.write("a.glb");
  second.write("b.glb");
  const SceneCatalogue catalogue({first.path(), second.path()});
  EXPECT_EQ(names(catalogue), (std::vector<std::string>{"a", "b"}));
  const auto found = catalogue.find("a");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->path, std::filesystem::canonical(first.path()) / "a.glb");
  EXPECT_TRUE(catalogue.find("a.glb"));
}

TEST(SceneCatalogue, NamesCannotEscapeTheRoots) {
  TemporaryFolder folder;
  const std::filesystem::path secret = folder.write("outside/secret.glb");
  folder.write("root/inside.glb");
  const SceneCatalogue catalogue({folder.path() / "root"});
  for (const std::string& name :
       {std::string("../outside/secret"), std::string("../outside/secret.glb"), secret.string(),
        std::string("inside/../../outside/secret"), std::string("./inside"),
        std::string("%2e%2e/outside/secret"), std::string("inside\0", 7), std::string()}) {
    EXPECT_FALSE(catalogue.find(name)) << name;
  }
  EXPECT_EQ(catalogue.find("../outside/secret").error().code, protocol::ErrorCode::not_found);
}

TEST(SceneCatalogue, AFileOfARootItselfIsFoundByItsName) {
  TemporaryFolder folder;
  folder.write("first/box.gltf");
  folder.write("first/more/ball.glb");
  folder.write("first/sky.exr");
  folder.write("second/box.glb", "12345");
  folder.write("second/cone.gltf");
  folder.write("second/cone.glb");
  const SceneCatalogue catalogue({folder.path() / "first", folder.path() / "second"});
  for (const char* name : {"box", "cone"}) {
    const auto found = catalogue.find_in_root(name);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->name, name);
    EXPECT_EQ(found->path, catalogue.find(name)->path) << "of the same precedence";
    EXPECT_EQ(found->root, catalogue.find(name)->root);
  }
  for (const char* name : {"ball", "more/ball", "sky", "box.gltf", "", "..", "../second/box"}) {
    EXPECT_FALSE(catalogue.find_in_root(name)) << name;
  }
  EXPECT_TRUE(catalogue.find_file_in_root("sky", {".hdr", ".exr"}));
}

TEST(SceneCatalogue, SymbolicLinksCannotEscapeTheRoots) {
  TemporaryFolder folder;
  folder.write("outside/secret.glb");
  folder.write("root/inside.glb");
  const auto root = folder.path() / "root";
  std::filesystem::create_symlink(folder.path() / "outside/secret.glb", root / "file_link.glb");
  std::filesystem::create_symlink(folder.path() / "outside", root / "folder_link");
  std::filesystem::create_symlink(root / "inside.glb", root / "alias.glb");
  const SceneCatalogue catalogue({root});
  EXPECT_EQ(names(catalogue), (std::vector<std::string>{"alias", "inside"}));
}

TEST(SceneCatalogue, AFolderNamedLikeASceneIsNotListed) {
  TemporaryFolder folder;
  folder.write("folder.glb/real.glb");
  const SceneCatalogue catalogue({folder.path()});
  EXPECT_EQ(names(catalogue), (std::vector<std::string>{"folder.glb/real"}));
}

TEST(SceneCatalogue, SuggestsTheNearestName) {
  TemporaryFolder folder;
  folder.write("atrium.glb");
  const auto found = SceneCatalogue({folder.path()}).find("atriun");
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("atrium"), std::string::npos) << found.error().message;
}

TEST(SceneCatalogue, RefusesARootThatIsNotAFolder) {
  TemporaryFolder folder;
  const auto file = folder.write("file.glb");
  EXPECT_THROW(SceneCatalogue({file}), std::runtime_error);
  EXPECT_THROW(SceneCatalogue({folder.path() / "missing"}), std::runtime_error);
}

TEST(EnvironmentBeside, PrefersTheSceneFileThenItsFolderThenTheRoot) {
  TemporaryFolder folder;
  const auto scene = folder.write("models/chair.glb");
  EXPECT_EQ(environment_beside(scene, folder.path()), std::nullopt);
  const auto of_root = folder.write("sky.hdr");
  EXPECT_EQ(environment_beside(scene, folder.path()), of_root);
  const auto of_folder = folder.write("models/sky.hdr");
  EXPECT_EQ(environment_beside(scene, folder.path()), of_folder);
  const auto own = folder.write("models/chair.hdr");
  EXPECT_EQ(environment_beside(scene, folder.path()), own);
}

TEST(EnvironmentSource, IsTheStudioWithoutAFile) {
  TemporaryFolder folder;
  const auto scene = folder.write("chair.glb");
  EnvironmentSource source(std::nullopt);
  EXPECT_EQ(source.path_for({.name = "chair", .path = scene, .root = folder.path()}), std::nullopt);
  const auto environment = source.environment_at({});
  EXPECT_EQ(environment->radiance, scene::studio_environment().radiance);
}

TEST(EnvironmentSource, TheLightInAScenesFileGivesWayToAForcedOneOnly) {
  scene::Scene lit;
  lit.environment =
      std::make_shared<const scene::Environment>(scene::constant_environment(glm::vec3(2.0f)));
  EnvironmentSource source(std::nullopt);
  EXPECT_TRUE(source.is_lit_by_its_file(lit));
  EXPECT_EQ(source.environment_of(lit, "beside.hdr"), lit.environment);
  EXPECT_TRUE(source.environment_of(scene::Scene(), {})->is_studio);
  EnvironmentSource forced("forced.hdr");
  EXPECT_FALSE(forced.is_lit_by_its_file(lit));
  EXPECT_TRUE(forced.environment_of(lit, {})->is_studio);
}

}  // namespace
}  // namespace heliograph::session
