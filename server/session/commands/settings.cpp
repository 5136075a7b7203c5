#include "protocol/settings/presets.hpp"
#include "session/commands/commands.hpp"

namespace heliograph::session {

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
    list.presets.push_back({std::string(preset.name), std::string(preset.description)});
  }
  return list;
}

}  // namespace

void add_settings_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_command<Empty, SettingsState>(
      dispatcher, host, "settings.get",
      [](Session& session, const Empty&, const std::string&) -> Result<SettingsState> {
        return session.settings();
      });
  add_command<SettingsPatch, SettingsApplied>(
      dispatcher, host, "settings.patch",
      [](Session& session, const SettingsPatch& request, const std::string& viewer) {
        return session.patch_settings(request.patch, viewer);
      });
  add_command<Empty, PresetList>(
      dispatcher, host, "settings.presets",
      [](Session&, const Empty&, const std::string&) -> Result<PresetList> {
        return list_presets();
      });
  add_command<PresetChoice, SettingsApplied>(
      dispatcher, host, "settings.preset",
      [](Session& session, const PresetChoice& request,
         const std::string& viewer) -> Result<SettingsApplied> {
        const Result<protocol::Preset> preset = protocol::find_preset(request.name);
        if (!preset) return preset.error();
        return session.patch_settings(preset->settings, viewer);
      });
}

}  // namespace heliograph::session
