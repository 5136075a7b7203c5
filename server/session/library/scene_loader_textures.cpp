// Scenes that a session shows already, with other textures.

#include <utility>

#include "session/library/scene_loader.hpp"

namespace heliograph::session {

void SceneLoader::load_textures(std::shared_ptr<Session> session, Textures textures,
                                std::optional<protocol::EditDocument> edits, const std::string& by,
                                Completion done) {
  const auto shown = session->scene().shown();
  if (!shown) return done(shown.error());
  const auto entry = catalogue_.find(shown->name);
  if (!entry) return done(entry.error());
  SceneKey key{.file = entry->path,
               .choice = shown->scene->choice,
               .environment = environments_.path_for(*entry).value_or(""),
               .device = session->device(),
               .textures = std::move(textures)};
  enqueue(std::move(key), *entry,
          {std::move(session), by, std::move(done), entry->name, std::move(edits), true});
}

std::optional<SceneLoader::Textures> SceneLoader::pending_textures(const Session& session) {
  const std::lock_guard lock(mutex_);
  for (const auto& job : jobs_) {
    for (const Waiter& waiter : job->waiters) {
      if (waiter.variant && waiter.session.get() == &session) return job->key.textures;
    }
  }
  return std::nullopt;
}

/// A session that asks again for what is being loaded is shown it once, as asked for last.
void SceneLoader::ask_again(Waiter& waiter, Waiter newer) {
  newer.sees_first_view = waiter.sees_first_view;
  if (newer.variant && !newer.edits) newer.edits = std::move(waiter.edits);
  newer.done = [first = std::move(waiter.done), then = std::move(newer.done)](auto outcome) {
    first(outcome);
    then(outcome);
  };
  waiter = std::move(newer);
}

/// Other textures add up: requests for them that this one replaces are answered with it.
void SceneLoader::join(Waiter& waiter, std::vector<Waiter>& replaced) {
  if (!waiter.variant) return;
  for (Waiter& other : replaced) {
    if (!other.variant) continue;
    if (!waiter.edits) waiter.edits = std::move(other.edits);
    waiter.done = [first = std::move(other.done), then = std::move(waiter.done)](auto outcome) {
      first(outcome);
      then(outcome);
    };
  }
  std::erase_if(replaced, [](const Waiter& other) { return other.variant; });
}

}  // namespace heliograph::session
