#include "session/scene_loader.hpp"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

#include "protocol/jsonrpc.hpp"
#include "render/renderer.hpp"
#include "session/scene_description.hpp"

namespace heliograph::session {

using protocol::Result;

namespace {

/// Reading a file is this much of the whole; the rest is upload and acceleration structure.
constexpr float import_share = 0.7f;

/// Thrown through the importer to end it.
struct Superseded {};

protocol::Error superseded() {
  return protocol::error::conflict("name", "another scene was asked for meanwhile");
}

}  // namespace

SceneLoader::SceneLoader(render::Engine& engine, const SceneCatalogue& catalogue,
                         std::optional<std::filesystem::path> environment,
                         const scene::ImportLimits& limits)
    : engine_(engine),
      catalogue_(catalogue),
      environments_(std::move(environment)),
      limits_(limits),
      thread_([this] { run(); }) {}

void SceneLoader::stop() {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_.exchange(true)) return;
  }
  condition_.notify_one();
  thread_.join();
  waiting_.reset();
}

void SceneLoader::load(std::shared_ptr<Session> session, const std::string& name,
                       const std::string& by, Completion done) {
  Result<CatalogueEntry> entry = catalogue_.find(name);
  if (!entry) return done(entry.error());
  std::optional<Request> displaced;
  {
    const std::lock_guard lock(mutex_);
    displaced = std::exchange(waiting_, Request{.session = std::move(session),
                                                .entry = *std::move(entry),
                                                .by = by,
                                                .done = std::move(done),
                                                .number = ++newest_number_});
  }
  condition_.notify_one();
  if (displaced) displaced->done(superseded());
}

void SceneLoader::run() {
  while (true) {
    std::optional<Request> request;
    {
      std::unique_lock lock(mutex_);
      condition_.wait(lock, [&] { return stopping_ || waiting_; });
      if (stopping_) return;
      request = std::exchange(waiting_, std::nullopt);
    }
    Result<protocol::SceneInfo> outcome = carry_out(*request);
    if (!outcome) {
      spdlog::warn("session {}: {} was not loaded: {}", request->session->name(),
                   request->entry.name, outcome.error().message);
    }
    request->done(std::move(outcome));
  }
}

Result<protocol::SceneInfo> SceneLoader::carry_out(const Request& request) {
  const Clock::time_point start = Clock::now();
  try {
    const auto environment = environments_.environment_for(request.entry);
    auto imported = scene::import_gltf(request.entry.path, limits_,
                                       [&](std::string_view stage, float fraction) {
                                         stop_if_superseded(request);
                                         report_progress(request, stage, import_share * fraction);
                                       });
    const auto scene = std::make_shared<const scene::Scene>(std::move(imported));
    stop_if_superseded(request);
    report_progress(request, "uploading", import_share);
    auto resources = engine_.upload(scene, *environment);
    stop_if_superseded(request);
    request.session->show(
        {.name = request.entry.name, .scene = scene, .resources = std::move(resources)},
        request.by);
    report_progress(request, "ready", 1.0f);
    spdlog::info("session {}: {} loaded in {:.2f} s, {} triangles", request.session->name(),
                 request.entry.name, std::chrono::duration<double>(Clock::now() - start).count(),
                 scene->triangle_count());
    return describe_scene(request.entry.name, *scene);
  } catch (const Superseded&) {
    return superseded();
  } catch (const scene::ImportError& failure) {
    return protocol::error::invalid("name", "cannot be loaded: " + std::string(failure.what()));
  } catch (const std::exception& failure) {
    spdlog::error("loading {}: {}", request.entry.name, failure.what());
    return protocol::error::internal();
  }
}

void SceneLoader::report_progress(const Request& request, std::string_view stage,
                                  float fraction) const {
  const protocol::SceneProgress progress{
      .name = request.entry.name, .stage = std::string(stage), .fraction = fraction};
  request.session->audience().send_all(protocol::make_notification("scene.progress", progress),
                                       "scene.progress");
}

void SceneLoader::stop_if_superseded(const Request& request) const {
  if (stopping_ || request.number != newest_number_) throw Superseded();
}

}  // namespace heliograph::session
