#pragma once

#include <string>
#include <vector>

#include "protocol/messages/edit_messages.hpp"
#include "protocol/result.hpp"
#include "scene/scene.hpp"

// A light as clients see it, and as the device does.

namespace heliograph::session {

/// Without a name.
protocol::LightInfo describe(const scene::Light& light);
/// The device's form of `info`, of which `device` is that of `initial`; what is the same in both
/// stays to the last bit.
shared::Light device_form(const protocol::LightInfo& info, const protocol::LightInfo& initial,
                          shared::Light device);
/// @return an error that names the member below "patch"
protocol::Result<protocol::LightInfo> patched(protocol::LightInfo light,
                                              const protocol::LightInfo& initial,
                                              const protocol::LightPatch& patch);
/// The patch that leads to `light` from one that differs in the members of these names.
protocol::LightPatch patch_of(const protocol::LightInfo& light,
                              const std::vector<std::string>& members);
/// All members of a light of this type that a patch may have.
protocol::LightPatch whole_patch(const protocol::LightInfo& light);

}  // namespace heliograph::session
