#pragma once

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "scene/gltf/export/scene_changes.hpp"

// The members of lights, from the device's form to KHR_lights_punctual and to our "extras".

namespace heliograph::scene {

/// Whether anything but the place differs by more than rounding.
bool has_other_values(const shared::Light& a, const shared::Light& b);
/// Whether the radius of a punctual light does, or its angular diameter.
bool has_other_size(const shared::Light& a, const shared::Light& b);

/// A light of KHR_lights_punctual, which is not of the types that have an area.
nlohmann::json new_punctual_light(const LightChange& light);
/// The members of one that differ from `before`. A new colour keeps the largest component that the
/// file's has, so that the animation of one of colour and intensity still suits the other.
void write_punctual_light(nlohmann::json& to, const shared::Light& before, const LightChange& now);
/// The names of these, as pointers of KHR_animation_pointer have them below the light.
std::vector<std::string_view> edited_members(const shared::Light& before, const LightChange& now);
/// Its radius or angular diameter, in the "extras" of its node.
void write_size(nlohmann::json& extras, const shared::Light& light);

nlohmann::json new_area_light(const LightChange& light);
void write_area_light(nlohmann::json& to, const LightChange& light);

}  // namespace heliograph::scene
