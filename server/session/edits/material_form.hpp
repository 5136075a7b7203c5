#pragma once

#include "protocol/messages/material_messages.hpp"
#include "protocol/result.hpp"
#include "scene/scene.hpp"

// A material as clients see it, and as the device does.

namespace heliograph::session {

/// What the file says of a material.
struct FileMaterial {
  shared::Material device;
  scene::MaterialLayers extensions;
};

/// The material of this number.
FileMaterial file_material(const scene::Scene& scene, std::size_t index);

/// Without a name.
protocol::MaterialInfo describe(const FileMaterial& material);
/// The device's form of `info` but for its layer; alpha, flags and textures are the file's.
shared::Material device_form(const protocol::MaterialInfo& info, shared::Material file);
/// Its extensions as a file has them, with the textures of `file`.
scene::MaterialLayers extensions_form(const protocol::MaterialInfo& info,
                                      scene::MaterialLayers file);
/// What its extensions add for the device.
shared::MaterialLayer layer_form(const protocol::MaterialInfo& info, const FileMaterial& file);
/// Whether both have the same extensions.
bool same_extensions(const protocol::MaterialInfo& a, const protocol::MaterialInfo& b);

/// @return an error that names the member below "patch"
protocol::Result<protocol::MaterialInfo> patched(protocol::MaterialInfo material,
                                                 const protocol::MaterialInfo& initial,
                                                 const protocol::MaterialPatch& patch);
/// The patch that leads to `material` from that of the file.
protocol::MaterialPatch patch_of(const protocol::MaterialInfo& material);

}  // namespace heliograph::session
