#include "session/commands/commands.hpp"

namespace heliograph::session {

using protocol::Empty;
using protocol::Result;
using protocol::SceneInfo;
using protocol::SceneListResult;
using protocol::SceneLoad;

namespace {

Result<SceneListResult> list_scenes(SessionHost& host) {
  SceneListResult result;
  for (const CatalogueEntry& entry : host.catalogue().list()) {
    result.scenes.push_back({.name = entry.name, .bytes = entry.bytes});
  }
  if (const auto info = host.default_session().scene_info()) result.current = info->name;
  return result;
}

}  // namespace

void add_scene_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<Empty, SceneListResult>(
      dispatcher, "scene.list",
      [&](const Empty&, const std::string&) { return list_scenes(host); });
  add_command<Empty, SceneInfo>(dispatcher, "scene.info", [&](const Empty&, const std::string&) {
    return host.default_session().scene_info();
  });
  dispatcher.add<SceneLoad, SceneInfo>(
      "scene.load", [&](const SceneLoad& request, const protocol::CallContext& context,
                        protocol::Completion<SceneInfo> done) {
        host.load_scene(request.name, context.viewer, std::move(done));
      });
}

}  // namespace heliograph::session
