#include "protocol/settings/presets.hpp"
#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

using protocol::Empty;
using protocol::PresetChoice;
using protocol::PresetList;
using protocol::Result;
using protocol::SettingsApplied;
using protocol::SettingsPatch;
using protocol::SettingsState;

namespace {

PresetList list_presets() {
  PresetList list;
  for (const protocol::Preset& preset : protocol::presets()) {
    list.presets.push_back(
        {std::string(preset.name), std::string(preset.description), preset.settings});
  }
  return list;
}

}  // namespace

void add_settings_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<methods::settings_get>(
      dispatcher, host,
      [](Session& session, const Empty&, const std::string&) -> Result<SettingsState> {
        return session.settings();
      });
  add_command<methods::settings_patch>(
      dispatcher, host,
      [](Session& session, const SettingsPatch& request, const std::string& viewer) {
        return session.patch_settings(request.patch, viewer);
      });
  add_command<methods::settings_presets>(
      dispatcher, host, [](Session&, const Empty&, const std::string&) -> Result<PresetList> {
        return list_presets();
      });
  add_command<methods::settings_preset>(dispatcher, host,
                                        [](Session& session, const PresetChoice& request,
                                           const std::string& viewer) -> Result<SettingsApplied> {
                                          const Result<protocol::Preset> preset =
                                              protocol::find_preset(request.name);
                                          if (!preset) return preset.error();
                                          return session.patch_settings(preset->settings, viewer);
                                        });
}

}  // namespace heliograph::session
