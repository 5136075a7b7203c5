#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Empty;
using protocol::Result;
using protocol::SceneCancelled;
using protocol::SceneInfo;
using protocol::SceneListResult;
using protocol::SceneLoad;

namespace {

Result<SceneListResult> list_scenes(const SessionHost& host, const Session& session) {
  SceneListResult result;
  for (const CatalogueEntry& entry : host.catalogue().list()) {
    result.scenes.push_back({.name = entry.name,
                             .bytes = entry.bytes,
                             .uploaded = host.was_uploaded(protocol::UploadKind::scene, entry)});
  }
  if (const auto info = session.scene().info()) result.current = info->name;
  return result;
}

}  // namespace

void add_scene_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_node_commands(dispatcher, host);
  add_section_commands(dispatcher, host);
  add_measurement_commands(dispatcher, host);
  add_annotation_commands(dispatcher, host);
  add_command<methods::scene_list>(dispatcher, host,
                                   [&](Session& session, const Empty&, const std::string&) {
                                     return list_scenes(host, session);
                                   });
  add_command<methods::scene_info>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string&) { return session.scene().info(); });
  add_command<methods::scene_unload>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string& viewer) -> Result<Empty> {
        session.scene().unload(viewer);
        return Empty();
      });
  dispatcher.add<methods::scene_load>([&](const SceneLoad& request,
                                          const protocol::CallContext& context,
                                          protocol::Completion<SceneInfo> done) {
    const auto session = host.sessions().session_of(context);
    if (!session) return done(session.error());
    host.load_scene(*session, request, context.viewer, std::move(done));
  });
  add_command<methods::scene_cancel>(dispatcher, host,
                                     [&](Session& session, const Empty&, const std::string&) {
                                       return host.cancel_load(session);
                                     });
}

}  // namespace heliograph::session
