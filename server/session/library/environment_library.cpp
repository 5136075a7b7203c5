#include "session/library/environment_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string_view>
#include <utility>

#include "protocol/json/suggestions.hpp"
#include "render/api/device_lost.hpp"
#include "render/api/renderer.hpp"
#include "scene/environment.hpp"
#include "scene/import.hpp"
#include "scene/studio.hpp"
#include "session/devices/render_devices.hpp"
#include "session/event_log.hpp"
#include "session/library/environment_thumbnail.hpp"

namespace heliograph::session {

using protocol::Result;

namespace {

constexpr std::size_t max_queued_environments = 8;
constexpr std::size_t max_queued_thumbnails = 64;
constexpr std::size_t max_cached_thumbnails = 512;
constexpr std::string_view studio_name = "studio";  // unless a file has it

std::vector<std::string> environment_extensions() {
  return {".hdr", ".exr"};
}

CatalogueEntry studio() {
  return {.name = std::string(studio_name), .path = {}, .root = {}};
}

scene::Environment environment_of(const CatalogueEntry& entry) {
  return entry.path.empty() ? scene::studio_environment() : scene::load_environment(entry.path);
}

}  // namespace

EnvironmentLibrary::EnvironmentLibrary(const RenderDevices& devices, SceneCatalogue catalogue)
    : devices_(devices),
      catalogue_(std::move(catalogue)),
      loader_("environment loader", max_queued_environments),
      thumbnail_maker_("environment thumbnails", max_queued_thumbnails) {}

void EnvironmentLibrary::stop() {
  loader_.stop();
  thumbnail_maker_.stop();
}

std::vector<CatalogueEntry> EnvironmentLibrary::list() const {
  std::vector<CatalogueEntry> files = catalogue_.list_files(environment_extensions());
  const auto at = std::ranges::lower_bound(files, studio_name, {}, &CatalogueEntry::name);
  if (at == files.end() || at->name != studio_name) {
    files.insert(at, studio());
  }
  return files;
}

Result<CatalogueEntry> EnvironmentLibrary::find(const std::string& name) const {
  const std::vector<CatalogueEntry> environments = list();
  std::vector<std::string_view> names;
  for (const CatalogueEntry& entry : environments) {
    if (entry.name == name || entry.name + entry.path.extension().string() == name) return entry;
    names.push_back(entry.name);
  }
  return protocol::error::not_found("name",
                                    "is not in the catalogue" + protocol::suggestion(name, names));
}

std::optional<CatalogueEntry> EnvironmentLibrary::find_in_root(const std::string& name) const {
  auto file = catalogue_.find_file_in_root(name, environment_extensions());
  return !file && name == studio_name ? studio() : file;
}

Result<void> EnvironmentLibrary::load_into(Session& session, const CatalogueEntry& entry,
                                           const std::string& by) {
  try {
    render::Engine& engine = devices_.engine(session.device());
    return session.scene().set_environment(entry.name, engine.prefilter(environment_of(entry)), by);
  } catch (const scene::ImportError& failure) {
    return protocol::error::invalid("name", "cannot be loaded: " + std::string(failure.what()));
  } catch (const render::DeviceLost& failure) {
    log_error({.session = session.name()},
              fmt::format("loading {}: {}", entry.name, failure.what()));
    if (on_device_loss_) on_device_loss_(session.device());
    return protocol::error::not_ready("the device was lost during loading; try again");
  } catch (const std::exception& failure) {
    log_error({.session = session.name()},
              fmt::format("loading {}: {}", entry.name, failure.what()));
    return protocol::error::internal();
  }
}

void EnvironmentLibrary::show(std::shared_ptr<Session> session, const std::string& name,
                              const std::string& by, std::function<void(Result<void>)> done) {
  Result<CatalogueEntry> entry = find(name);
  if (!entry) return done(entry.error());
  const bool taken = loader_.post([this, session = std::move(session), entry = *std::move(entry),
                                   by, done] { done(load_into(*session, entry, by)); });
  if (!taken) {
    done(protocol::error::full("too many environment loads are pending",
                               std::to_string(max_queued_environments)));
  }
}

void EnvironmentLibrary::thumbnail(const std::string& name, Thumbnail done) {
  Result<CatalogueEntry> entry = find(name);
  if (!entry) return done(entry.error());
  const bool taken = thumbnail_maker_.post(
      [this, entry = *std::move(entry), done] { done(make_thumbnail(entry)); });
  if (!taken) {
    done(protocol::error::full("too many thumbnails are pending",
                               std::to_string(max_queued_thumbnails)));
  }
}

void EnvironmentLibrary::forget_thumbnail(const std::string& name) {
  // Where too many wait it stays, and gives way to others.
  (void)thumbnail_maker_.post([this, name] { thumbnails_.erase(name); });
}

Result<std::vector<std::uint8_t>> EnvironmentLibrary::make_thumbnail(const CatalogueEntry& entry) {
  try {
    const scene::SourceFile file = scene::examine_file(entry.path);
    const auto cached = thumbnails_.find(entry.name);
    if (cached != thumbnails_.end() && cached->second.file == file) return cached->second.png;
    std::vector<std::uint8_t> png = environment_thumbnail(environment_of(entry));
    if (thumbnails_.size() >= max_cached_thumbnails) thumbnails_.clear();
    thumbnails_[entry.name] = {file, png};
    return png;
  } catch (const scene::ImportError& failure) {
    return protocol::error::invalid("name", "cannot be loaded: " + std::string(failure.what()));
  }
}

}  // namespace heliograph::session
