#include <nlohmann/json.hpp>

#include "session/commands/commands.hpp"
#include "session/edits/edited_parts.hpp"

// Lights, materials and the environment of a session's scene.

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Empty;
using protocol::EnvironmentSet;
using protocol::EnvironmentState;
using protocol::LightList;
using protocol::LightsPatch;
using protocol::LightState;
using protocol::MaterialList;
using protocol::MaterialsPatch;
using protocol::MaterialState;
using protocol::Result;

namespace {

EnvironmentState describe_environment(SessionHost& host, const Session& session) {
  EnvironmentState state = session.scene().environment();
  for (const CatalogueEntry& entry : host.environments().list()) {
    state.environments.push_back(
        {.name = entry.name,
         .bytes = entry.bytes,
         .uploaded = host.was_uploaded(protocol::UploadKind::environment, entry)});
  }
  return state;
}

Result<void> rotate_environment(Session& session, float degrees, const std::string& by) {
  const protocol::RawJson patch(nlohmann::json{{"environment", {{"rotation", degrees}}}});
  const auto applied = session.patch_settings(patch, by);
  if (!applied) return applied.error();
  return {};
}

/// Answers when the other environment is there, if one was asked for.
void set_environment(SessionHost& host, const std::shared_ptr<Session>& session,
                     const EnvironmentSet& request, const std::string& by,
                     protocol::Completion<EnvironmentState> done) {
  const auto finish = [&host, session, rotation = request.rotation, by,
                       done = std::move(done)](Result<void> outcome) {
    if (outcome && rotation) outcome = rotate_environment(*session, *rotation, by);
    if (!outcome) return done(outcome.error());
    done(describe_environment(host, *session));
  };
  if (request.name.value) {
    host.environments().show(session, *request.name.value, by, finish);
  } else if (request.name.reset) {
    finish(session->scene().set_environment(std::nullopt, nullptr, by));
  } else {
    finish({});
  }
}

/// Answers when the document's environment is there, if it names one.
void apply_edits(SessionHost& host, const std::shared_ptr<Session>& session,
                 const protocol::EditDocument& document, const std::string& by,
                 protocol::Completion<protocol::EditsState> done) {
  const std::optional<std::string> name =
      document.environment ? document.environment->name : std::nullopt;
  if (name) {
    const auto known = host.environments().find(*name);
    if (!known) return done(below(known.error(), "edits.environment"));
  }
  host.apply_edits(session, document, by, [&host, session, name, by, done](Result<void> applied) {
    if (!applied) return done(applied.error());
    if (!name) return done(session->scene().edits());
    host.environments().show(session, *name, by, [session, done](Result<void> outcome) {
      if (!outcome) return done(below(outcome.error(), "edits.environment"));
      done(session->scene().edits());
    });
  });
}

}  // namespace

void add_edit_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::lights_list>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string&) { return session.scene().lights(); });
  add_command<methods::lights_patch>(
      dispatcher, host,
      [](Session& session, const LightsPatch& request, const std::string& viewer) {
        return session.scene().patch_light(request, viewer);
      });
  add_command<methods::lights_add>(
      dispatcher, host,
      [](Session& session, const protocol::LightAdd& request, const std::string& viewer) {
        return session.scene().add_light(request, viewer);
      });
  add_command<methods::lights_remove>(
      dispatcher, host,
      [](Session& session, const protocol::LightName& request, const std::string& viewer) {
        return session.scene().remove_light(request, viewer);
      });
  add_command<methods::edits_get>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string&) { return session.scene().edits(); });
  dispatcher.add<methods::edits_apply>([&host](const protocol::EditsApply& request,
                                               const protocol::CallContext& context,
                                               protocol::Completion<protocol::EditsState> done) {
    const auto session = host.sessions().session_of(context);
    if (!session) return done(session.error());
    apply_edits(host, *session, request.edits, context.viewer, std::move(done));
  });
  add_command<methods::materials_list>(dispatcher, host,
                                       [](Session& session, const Empty&, const std::string&) {
                                         return session.scene().materials();
                                       });
  add_command<methods::materials_patch>(
      dispatcher, host,
      [](Session& session, const MaterialsPatch& request, const std::string& viewer) {
        return session.scene().patch_material(request, viewer);
      });
  add_command<methods::environment_list>(
      dispatcher, host,
      [&host](Session& session, const Empty&, const std::string&) -> Result<EnvironmentState> {
        return describe_environment(host, session);
      });
  dispatcher.add<methods::environment_set>([&host](const EnvironmentSet& request,
                                                   const protocol::CallContext& context,
                                                   protocol::Completion<EnvironmentState> done) {
    const auto session = host.sessions().session_of(context);
    if (!session) return done(session.error());
    set_environment(host, *session, request, context.viewer, std::move(done));
  });
}

}  // namespace heliograph::session
