#include "session/library/scene_cache.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <future>

#include "tests/support/temporary_folder.hpp"

namespace heliograph::session {
namespace {

SceneKey key(const char* file) {
  return {.file = file, .choice = {}, .environment = {}};
}

LoadedScene scene_of(std::uint64_t bytes) {
  return {.name = "box",
          .scene = std::make_shared<const scene::Scene>(),
          .resources = nullptr,
          .environment = {},
          .host_bytes = bytes / 4,
          .device_bytes = bytes - bytes / 4};
}

TEST(SceneCache, FindsTheSceneOfTheSameKeyOnly) {
  SceneCache cache(1000);
  const LoadedScene shown = cache.add(key("a"), scene_of(100), {});
  EXPECT_EQ(cache.find(key("a"))->scene, shown.scene);
  EXPECT_FALSE(cache.find(key("b")));
  SceneKey other = key("a");
  other.choice.variant = "golden";
  EXPECT_FALSE(cache.find(other));
  other = key("a");
  other.environment = "sky.hdr";
  EXPECT_FALSE(cache.find(other));
}

TEST(SceneCache, EvictsTheLeastRecentlyUsedUnshownScene) {
  SceneCache cache(250);
  for (const char* name : {"a", "b", "c"}) cache.add(key(name), scene_of(100), {});
  ASSERT_TRUE(cache.find(key("a"))) << "used again";
  EXPECT_TRUE(cache.trim());
  EXPECT_TRUE(cache.find(key("a")));
  EXPECT_FALSE(cache.find(key("b")));
  EXPECT_TRUE(cache.find(key("c")));
  const CacheTotals totals = cache.totals();
  EXPECT_EQ(totals.evictions, 1u);
  EXPECT_EQ(totals.entries, 2u);
  EXPECT_EQ(totals.bytes, 200u);
}

TEST(SceneCache, KeepsShownScenesBeyondTheLimit) {
  SceneCache cache(0);
  std::optional<LoadedScene> shown = cache.add(key("a"), scene_of(100), {});
  EXPECT_FALSE(cache.trim());
  EXPECT_TRUE(cache.find(key("a")));
  shown.reset();
  EXPECT_TRUE(cache.trim());
  EXPECT_FALSE(cache.find(key("a")));
  EXPECT_EQ(cache.totals().bytes, 0u);
}

TEST(SceneCache, APointerToAnyPartKeepsAScene) {
  SceneCache cache(0);
  const auto part = cache.add(key("a"), scene_of(100), {}).resources;
  EXPECT_FALSE(cache.trim()) << "a null pointer that shares in the entry";
}

TEST(SceneCache, DropsASceneWhoseFileChanged) {
  const heliograph::test::TemporaryFolder folder;
  const auto file = folder.write("box.glb", "first");
  SceneCache cache(1000);
  cache.add(key("a"), scene_of(100), {scene::examine_file(file)});
  EXPECT_TRUE(cache.find(key("a")));
  folder.write("box.glb", "second");
  EXPECT_FALSE(cache.find(key("a")));
  EXPECT_EQ(cache.totals().bytes, 0u);
}

TEST(SceneCache, FreesASceneWhoseFileIsGoneWhenItIsNotShown) {
  const heliograph::test::TemporaryFolder folder;
  const auto file = folder.write("box.glb");
  SceneCache cache(1000);
  std::optional<LoadedScene> shown =
      cache.add(key("a"), scene_of(100), {scene::examine_file(file)});
  cache.add(key("b"), scene_of(100), {scene::examine_file(folder.write("other.glb"))});
  std::filesystem::remove(file);
  EXPECT_TRUE(cache.trim());
  EXPECT_EQ(cache.totals().bytes, 200u) << "a session shows it";
  shown.reset();
  EXPECT_TRUE(cache.trim());
  EXPECT_EQ(cache.totals().bytes, 100u);
  EXPECT_EQ(cache.totals().evictions, 0u);
  EXPECT_TRUE(cache.find(key("b")));
}

TEST(SceneCache, ReplacesASceneOfTheSameKey) {
  SceneCache cache(1000);
  cache.add(key("a"), scene_of(100), {});
  const LoadedScene newer = cache.add(key("a"), scene_of(300), {});
  EXPECT_EQ(cache.find(key("a"))->scene, newer.scene);
  EXPECT_EQ(cache.totals().bytes, 300u);
}

SceneKey on_device(SceneKey key, std::size_t device) {
  key.device = device;
  return key;
}

TEST(SceneCache, HasASceneOncePerDeviceWithTheHostsPartOnce) {
  SceneCache cache(1000);
  const LoadedScene scene = scene_of(100);
  cache.add(key("a"), scene, {});
  EXPECT_FALSE(cache.find(on_device(key("a"), 1)));
  const auto elsewhere = cache.find_elsewhere(on_device(key("a"), 1));
  ASSERT_TRUE(elsewhere);
  EXPECT_EQ(elsewhere->scene.scene, scene.scene);
  EXPECT_FALSE(cache.find_elsewhere(on_device(key("b"), 1)));
  cache.add(on_device(key("a"), 1), elsewhere->scene, {});
  EXPECT_EQ(cache.totals().bytes, 100u + 75u);
  cache.clear(0);
  EXPECT_FALSE(cache.find(key("a")));
  EXPECT_TRUE(cache.find(on_device(key("a"), 1)));
  EXPECT_EQ(cache.totals().bytes, 100u);
}

TEST(SceneCache, FindsNoSceneElsewhereWhoseFileChanged) {
  const heliograph::test::TemporaryFolder folder;
  const auto file = folder.write("box.glb", "first");
  SceneCache cache(1000);
  cache.add(key("a"), scene_of(100), {scene::examine_file(file)});
  EXPECT_TRUE(cache.find_elsewhere(on_device(key("a"), 1)));
  folder.write("box.glb", "second");
  EXPECT_FALSE(cache.find_elsewhere(on_device(key("a"), 1)));
}

TEST(SceneCache, TellsWhenASceneIsNotShownAnyMore) {
  const auto released = std::make_shared<WakeEvent>();
  SceneCache cache(0, released);
  std::optional<LoadedScene> shown = cache.add(key("a"), scene_of(100), {});
  auto part = shown->scene;
  released->take();
  shown.reset();
  EXPECT_FALSE(released->take());
  part.reset();
  EXPECT_TRUE(released->take());
  EXPECT_TRUE(cache.trim());
  EXPECT_EQ(cache.totals().entries, 0u);
}

/// Whether another thread can use the cache while the scene of the key "a" is freed by `drop`.
bool is_usable_during(SceneCache& cache, const std::vector<scene::SourceFile>& sources,
                      const std::function<void()>& drop) {
  std::future<CacheTotals> asked;  // ends after the scene, which a cache that is locked waits for
  bool answered = false;
  LoadedScene scene = scene_of(100);
  scene.scene = {new scene::Scene, [&](const scene::Scene* freed) {
                   delete freed;
                   asked = std::async(std::launch::async, [&] { return cache.totals(); });
                   answered = asked.wait_for(std::chrono::seconds(5)) == std::future_status::ready;
                 }};
  cache.add(key("a"), std::move(scene), sources);
  drop();
  return answered && asked.get().bytes == cache.totals().bytes;
}

TEST(SceneCache, FreesScenesWithoutItsLock) {
  const heliograph::test::TemporaryFolder folder;
  const std::vector sources{scene::examine_file(folder.write("box.glb", "first"))};
  SceneCache cache(0);
  EXPECT_TRUE(is_usable_during(cache, {}, [&] { cache.trim(); }));
  EXPECT_TRUE(is_usable_during(cache, {}, [&] { cache.clear(0); }));
  EXPECT_TRUE(is_usable_during(cache, {}, [&] { cache.add(key("a"), scene_of(300), {}); }));
  EXPECT_TRUE(is_usable_during(cache, sources, [&] {
    folder.write("box.glb", "second");
    EXPECT_FALSE(cache.find(key("a")));
  }));
  EXPECT_EQ(cache.totals().bytes, 0u);
}

}  // namespace
}  // namespace heliograph::session
