#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Empty;

void add_bookmark_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::bookmarks_list>(
      dispatcher, host, [](Session& session, const Empty&, const std::string&) {
        return protocol::Result<protocol::BookmarkList>(session.camera().bookmarks());
      });
  add_command<methods::bookmarks_add>(
      dispatcher, host,
      [](Session& session, const protocol::BookmarkAdd& request, const std::string& viewer) {
        return session.camera().add_bookmark(request, viewer);
      });
  add_command<methods::bookmarks_rename>(
      dispatcher, host,
      [](Session& session, const protocol::BookmarkRename& request, const std::string& viewer) {
        return session.camera().rename_bookmark(request, viewer);
      });
  add_command<methods::bookmarks_remove>(
      dispatcher, host,
      [](Session& session, const protocol::BookmarkName& request, const std::string& viewer) {
        return session.camera().remove_bookmark(request, viewer);
      });
}

}  // namespace heliograph::session
