#include "session/commands/commands.hpp"

namespace heliograph::session {

using protocol::Empty;
using protocol::Result;
using protocol::SettingsApplied;
using protocol::SettingsPatch;
using protocol::SettingsState;

void add_settings_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<Empty, SettingsState>(dispatcher, "settings.get",
                                    [&](const Empty&, const std::string&) -> Result<SettingsState> {
                                      return host.default_session().settings();
                                    });
  add_command<SettingsPatch, SettingsApplied>(
      dispatcher, "settings.patch", [&](const SettingsPatch& request, const std::string& viewer) {
        return host.default_session().patch_settings(request.patch, viewer);
      });
}

}  // namespace heliograph::session
