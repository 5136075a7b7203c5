#include "session/edits/animated_members.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include "session/library/scene_description.hpp"

namespace heliograph::session {
namespace {

using protocol::LightInfo;
using protocol::MaterialInfo;
using Pointed = scene::PointedProperty;

glm::vec3 color_of(const TrackValue& value) {
  return {value.numbers[0], value.numbers[1], value.numbers[2]};
}

const TrackValue* find_value(std::span<const TrackValue> values, Pointed property) {
  const auto found = std::ranges::find(values, property, &TrackValue::property);
  return found == values.end() ? nullptr : &*found;
}

template <class Info>
bool was_edited(const Info& info, std::string_view member) {
  return std::ranges::find(info.changed, member) != info.changed.end();
}

void assign(float& member, const TrackValue& value) {
  member = value.numbers[0];
}
void assign(protocol::Vec3& member, const TrackValue& value) {
  member = to_protocol(color_of(value));
}
template <class Value>
void assign(std::optional<Value>& member, const TrackValue& value) {
  if (member) assign(*member, value);
}

/// Calls `visit` with the name of the member that a property alone gives, and with the member.
void visit_member(Pointed property, const auto& visit) {
  using Info = MaterialInfo;
  switch (property) {
    case Pointed::base_color:
      return visit("base_color", &Info::base_color);
    case Pointed::metallic:
      return visit("metallic", &Info::metallic);
    case Pointed::roughness:
      return visit("roughness", &Info::roughness);
    case Pointed::normal_scale:
      return visit("normal_scale", &Info::normal_scale);
    case Pointed::occlusion_strength:
      return visit("occlusion_strength", &Info::occlusion_strength);
    case Pointed::ior:
      return visit("ior", &Info::ior);
    case Pointed::specular:
      return visit("specular", &Info::specular);
    case Pointed::specular_color:
      return visit("specular_color", &Info::specular_color);
    case Pointed::clearcoat:
      return visit("clearcoat", &Info::clearcoat);
    case Pointed::clearcoat_roughness:
      return visit("clearcoat_roughness", &Info::clearcoat_roughness);
    case Pointed::clearcoat_normal_scale:
      return visit("clearcoat_normal_scale", &Info::clearcoat_normal_scale);
    case Pointed::sheen_color:
      return visit("sheen_color", &Info::sheen_color);
    case Pointed::sheen_roughness:
      return visit("sheen_roughness", &Info::sheen_roughness);
    case Pointed::transmission:
      return visit("transmission", &Info::transmission);
    case Pointed::thickness:
      return visit("thickness", &Info::thickness);
    case Pointed::attenuation_distance:
      return visit("attenuation_distance", &Info::attenuation_distance);
    case Pointed::attenuation_color:
      return visit("attenuation_color", &Info::attenuation_color);
    case Pointed::dispersion:
      return visit("dispersion", &Info::dispersion);
    case Pointed::iridescence:
      return visit("iridescence", &Info::iridescence);
    case Pointed::iridescence_ior:
      return visit("iridescence_ior", &Info::iridescence_ior);
    case Pointed::iridescence_thickness_minimum:
      return visit("iridescence_thickness_minimum", &Info::iridescence_thickness_minimum);
    case Pointed::iridescence_thickness_maximum:
      return visit("iridescence_thickness_maximum", &Info::iridescence_thickness_maximum);
    case Pointed::anisotropy:
      return visit("anisotropy", &Info::anisotropy);
    case Pointed::anisotropy_rotation:
      return visit("anisotropy_rotation", &Info::anisotropy_rotation);
    case Pointed::diffuse_transmission:
      return visit("diffuse_transmission", &Info::diffuse_transmission);
    case Pointed::diffuse_transmission_color:
      return visit("diffuse_transmission_color", &Info::diffuse_transmission_color);
    default:
      return;
  }
}

/// The product of colour and strength, where a value gives one of both.
std::optional<glm::vec3> product(const TrackValue* color, const glm::vec3& file_color,
                                 const TrackValue* strength, float file_strength) {
  if (!color && !strength) return std::nullopt;
  return (color ? color_of(*color) : file_color) *
         (strength ? strength->numbers[0] : file_strength);
}

/// As describe() divides a light into both.
void animate_color(LightInfo& light, const glm::vec3& product) {
  const float intensity = std::max({product.x, product.y, product.z});
  if (!was_edited(light, "intensity")) light.intensity = intensity;
  const bool edited = was_edited(light, "color") || was_edited(light, "temperature");
  if (!edited && intensity > 0.0f) light.color = to_protocol(product / intensity);
}

void animate_cone(LightInfo& light, std::span<const TrackValue> values) {
  const auto set = [&](Pointed property, const char* name, std::optional<float>& member) {
    const TrackValue* const value = find_value(values, property);
    if (value && member && !was_edited(light, name)) member = glm::degrees(value->numbers[0]);
  };
  set(Pointed::inner_cone, "inner_cone", light.inner_cone);
  set(Pointed::outer_cone, "outer_cone", light.outer_cone);
  if (light.outer_cone) light.inner_cone = std::min(*light.inner_cone, *light.outer_cone);
}

}  // namespace

LightInfo animated(LightInfo light, const scene::PunctualLight& file,
                   std::span<const TrackValue> values) {
  const auto color = product(find_value(values, Pointed::light_color), file.color,
                             find_value(values, Pointed::light_intensity), file.intensity);
  if (color) animate_color(light, *color);
  const TrackValue* const range = find_value(values, Pointed::light_range);
  if (range && !was_edited(light, "range")) assign(light.range, *range);
  animate_cone(light, values);
  return light;
}

MaterialInfo animated(MaterialInfo material, const scene::MaterialLayers& file,
                      std::span<const TrackValue> values) {
  const auto emissive =
      product(find_value(values, Pointed::emissive), file.emissive_factor,
              find_value(values, Pointed::emissive_strength), file.emissive_strength);
  if (emissive && !was_edited(material, "emissive")) material.emissive = to_protocol(*emissive);
  for (const TrackValue& value : values) {
    visit_member(value.property, [&](const char* name, auto member) {
      if (!was_edited(material, name)) assign(material.*member, value);
    });
  }
  return material;
}

bool is_of_layer(Pointed property) {
  switch (property) {
    case Pointed::base_color:
    case Pointed::metallic:
    case Pointed::roughness:
    case Pointed::emissive:
    case Pointed::emissive_strength:
    case Pointed::normal_scale:
    case Pointed::occlusion_strength:
      return false;
    default:
      return true;
  }
}

void animate(scene::TextureTransform& transform, const TrackValue& value) {
  const glm::vec2 pair(value.numbers[0], value.numbers[1]);
  if (value.property == Pointed::texture_offset) transform.offset = pair;
  if (value.property == Pointed::texture_rotation) transform.rotation = value.numbers[0];
  if (value.property == Pointed::texture_scale) transform.scale = pair;
}

}  // namespace heliograph::session
