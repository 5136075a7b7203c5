#include "session/library/scene_thumbnails.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "scene/source_file.hpp"

namespace heliograph::session {

using protocol::Result;

namespace {

constexpr std::size_t most_in_memory = 256;

/// FNV-1a.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char letter : text) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
  }
  return hash;
}

std::optional<SceneThumbnails::File> read_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return std::nullopt;
  SceneThumbnails::File bytes{std::istreambuf_iterator<char>(stream), {}};
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

/// Another server may read the folder meanwhile: the file is complete from the start.
void write_file(const std::filesystem::path& path, const SceneThumbnails::File& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::filesystem::path part = path;
  part += ".part";
  std::ofstream stream(part, std::ios::binary);
  stream.exceptions(std::ios::failbit | std::ios::badbit);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.close();
  std::filesystem::rename(part, path);
}

}  // namespace

SceneThumbnails::SceneThumbnails(const SceneCatalogue& catalogue, std::filesystem::path folder,
                                 Render render)
    : catalogue_(catalogue), folder_(std::move(folder)), render_(std::move(render)) {}

/// A scene that has been changed has another file.
std::filesystem::path SceneThumbnails::file_of(const CatalogueEntry& entry) const {
  const scene::SourceFile source = scene::examine_file(entry.path);
  const std::string identity = entry.path.string() + '\n' + std::to_string(source.bytes) + '\n' +
                               std::to_string(source.modified);
  return folder_ / fmt::format("{:016x}.jpg", hash_of(identity));
}

Result<SceneThumbnails::File> SceneThumbnails::get(const std::string& scene) {
  const Result<CatalogueEntry> entry = catalogue_.find(scene);
  if (!entry) return entry.error();
  const std::filesystem::path file = file_of(*entry);
  if (auto image = read_file(file)) return *std::move(image);
  const std::lock_guard lock(mutex_);
  if (const auto kept = kept_.find(file); kept != kept_.end()) return kept->second;
  if (failed_.contains(file)) return protocol::error::invalid("name", "cannot be loaded");
  const bool known = rendering_ == entry->name || std::ranges::count(waiting_, entry->name) > 0;
  if (!known) waiting_.push_back(entry->name);
  return protocol::error::not_ready("is rendered when the server has nothing else to do");
}

void SceneThumbnails::forget(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove(file, ignored);
  const std::lock_guard lock(mutex_);
  kept_.erase(file);
  failed_.erase(file);
}

bool SceneThumbnails::has_work() const {
  const std::lock_guard lock(mutex_);
  return !waiting_.empty();
}

void SceneThumbnails::render_next() {
  std::string scene;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty() || !rendering_.empty()) return;
    scene = rendering_ = waiting_.front();
    waiting_.pop_front();
  }
  const Result<CatalogueEntry> entry = catalogue_.find(scene);
  if (!entry) return rendered(scene, {}, entry.error());
  const std::filesystem::path file = file_of(*entry);
  render_(scene, [this, scene, file](const Result<File>& image) { rendered(scene, file, image); });
}

/// The scene may have been deleted meanwhile, and its image forgotten before it was there.
void SceneThumbnails::rendered(const std::string& scene, const std::filesystem::path& file,
                               const Result<File>& image) {
  keep(scene, file, image);
  if (!is_current(scene, file)) forget(file);
  const std::lock_guard lock(mutex_);
  rendering_.clear();
}

/// Whether it is the image of the file that the scene has now: it may be gone, or another one.
bool SceneThumbnails::is_current(const std::string& scene,
                                 const std::filesystem::path& file) const {
  const Result<CatalogueEntry> entry = catalogue_.find(scene);
  return entry && file_of(*entry) == file;
}

/// What fails for want of room is rendered when it is asked for again.
void SceneThumbnails::keep(const std::string& scene, const std::filesystem::path& file,
                           const Result<File>& image) {
  bool written = false;
  if (image && !folder_.empty()) {
    try {
      write_file(file, *image);
      written = true;
    } catch (const std::exception& failure) {
      spdlog::warn("the thumbnail of {} stays in memory: {}", scene, failure.what());
    }
  }
  const std::lock_guard lock(mutex_);
  if (image && !written) {
    if (kept_.size() >= most_in_memory) kept_.clear();
    kept_[file] = *image;
  }
  if (!image && image.error().code == protocol::ErrorCode::invalid_params) failed_.insert(file);
}

}  // namespace heliograph::session
