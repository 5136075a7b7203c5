#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "protocol/result.hpp"
#include "protocol/settings/settings.hpp"

namespace heliograph::protocol {

/// The whole tree, groups as nested objects.
nlohmann::json to_json(const Settings& settings);

/// The settings whose values differ, as a patch that turns `before` into `after`.
nlohmann::json difference(const Settings& before, const Settings& after);

/// Applies a merge patch (RFC 7386): members replace, absent members stay, null resets a setting or
/// a whole group to its default. All or nothing: an unknown key, a wrong type or a value out of
/// range gives ErrorCode::invalid_params with path, reason and limit, and `settings` is unchanged.
/// Returns the patch as applied, with each null replaced by the default value.
Result<nlohmann::json> apply_patch(Settings& settings, const nlohmann::json& patch);

/// JSON Schema 2020-12 of the tree. Leaves carry "x-unit", "x-resets" and "x-order", groups
/// "title" and "x-order", so that a client can build its controls from it.
nlohmann::json settings_schema();

/// Sets one setting from a JSON value; null resets it. The path must exist.
Result<void> assign_setting(Settings& settings, const SettingDescriptor& setting,
                            const nlohmann::json& value);

}  // namespace heliograph::protocol
