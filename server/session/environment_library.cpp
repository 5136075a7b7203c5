#include "session/environment_library.hpp"

#include <spdlog/spdlog.h>

#include <exception>
#include <string_view>
#include <utility>

#include "protocol/suggestions.hpp"
#include "render/renderer.hpp"
#include "scene/environment.hpp"
#include "scene/import.hpp"

namespace heliograph::session {

using protocol::Result;

namespace {

constexpr std::size_t waiting_environments = 8;

Result<void> put_around(render::Engine& engine, Session& session, const CatalogueEntry& entry,
                        const std::string& by) {
  try {
    return session.set_environment(entry.name,
                                   engine.prefilter(scene::load_environment(entry.path)), by);
  } catch (const scene::ImportError& failure) {
    return protocol::error::invalid("name", "cannot be loaded: " + std::string(failure.what()));
  } catch (const std::exception& failure) {
    spdlog::error("loading {}: {}", entry.name, failure.what());
    return protocol::error::internal();
  }
}

}  // namespace

EnvironmentLibrary::EnvironmentLibrary(render::Engine& engine, const SceneCatalogue& catalogue)
    : engine_(engine),
      catalogue_(catalogue),
      loader_("environment loader", waiting_environments) {}

std::vector<CatalogueEntry> EnvironmentLibrary::list() const {
  return catalogue_.list_files({".hdr", ".exr"});
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

void EnvironmentLibrary::show(std::shared_ptr<Session> session, const std::string& name,
                              const std::string& by,
                              std::function<void(Result<void>)> done) {
  Result<CatalogueEntry> entry = find(name);
  if (!entry) return done(entry.error());
  const bool taken = loader_.post(
      [&engine = engine_, session = std::move(session), entry = *std::move(entry), by, done] {
        done(put_around(engine, *session, entry, by));
      });
  if (!taken) {
    done(protocol::error::full("too many environments are being loaded",
                               std::to_string(waiting_environments)));
  }
}

}  // namespace heliograph::session
