#include "scene/gltf/export/light_values.hpp"

#include <algorithm>
#include <cmath>

namespace heliograph::scene {
namespace {

using nlohmann::json;

// What the conversion to the members that clients see and back may change.
constexpr float rounding = 1e-5f;

bool differs(float a, float b) {
  return std::abs(a - b) > rounding * std::max(std::abs(a), std::abs(b));
}

bool differs(const glm::vec3& a, const glm::vec3& b) {
  return differs(a.x, b.x) || differs(a.y, b.y) || differs(a.z, b.z);
}

bool has_other_cone(const shared::Light& a, const shared::Light& b) {
  return differs(a.spot_scale, b.spot_scale) || differs(a.spot_offset, b.spot_offset);
}

float largest(const glm::vec3& color) {
  return std::max({color.x, color.y, color.z});
}

/// The largest component of the colour that a light of the document has; 1 where it has none, or a
/// black one.
float largest_of_document(const json& light) {
  const auto color = light.find("color");
  if (color == light.end() || !color->is_array()) return 1.0f;
  float most = 0.0f;
  for (const json& component : *color) {
    if (component.is_number()) most = std::max(most, component.get<float>());
  }
  constexpr float black = 1e-3f;
  return most > black ? std::min(most, 1.0f) : 1.0f;
}

/// A colour with the largest component of the one there is, and a factor: `intensity` is its name.
void write_color(json& to, const char* intensity, const LightChange& light) {
  const glm::vec3& product = light.device.color;
  const float most = largest(product);
  const float kept = largest_of_document(to);
  const float factor = most / kept;
  if (factor > 0.0f) to["color"] = {product.x / factor, product.y / factor, product.z / factor};
  to[intensity] = light.off ? 0.0f : factor;
}

/// Whether the colours differ but for a factor. Black has none.
bool has_other_hue(const glm::vec3& a, const glm::vec3& b) {
  const float of_a = largest(a);
  const float of_b = largest(b);
  return of_a > 0.0f && of_b > 0.0f && differs(a / of_a, b / of_b);
}

/// The cosines of a cone's angles.
struct Cone {
  double inner = 1.0;
  double outer = 1.0;
};

/// That of the device's falloff; see read_cone().
Cone cone_of(const shared::Light& light) {
  const double outer = std::clamp(-double(light.spot_offset) / light.spot_scale, 0.0, 1.0);
  return {.inner = std::clamp(outer + 1.0 / light.spot_scale, 0.0, 1.0), .outer = outer};
}

void write_cone(json& to, const shared::Light& light) {
  const Cone cone = cone_of(light);
  to["spot"]["innerConeAngle"] = std::acos(cone.inner);
  to["spot"]["outerConeAngle"] = std::acos(cone.outer);
}

const char* punctual_type(const shared::Light& light) {
  if (light.type == shared::light_directional) return "directional";
  return light.type == shared::light_point ? "point" : "spot";
}

}  // namespace

bool has_other_size(const shared::Light& a, const shared::Light& b) {
  return differs(a.radius, b.radius);
}

bool has_other_values(const shared::Light& a, const shared::Light& b) {
  return differs(a.color, b.color) || differs(a.range, b.range) || has_other_size(a, b) ||
         has_other_cone(a, b) || differs(a.half_width, b.half_width) ||
         differs(a.half_height, b.half_height);
}

json new_punctual_light(const LightChange& light) {
  json made{{"name", light.name}, {"type", punctual_type(light.device)}};
  write_color(made, "intensity", light);
  if (light.device.range > 0.0f) made["range"] = light.device.range;
  if (light.device.type == shared::light_spot) write_cone(made, light.device);
  return made;
}

void write_punctual_light(json& to, const shared::Light& before, const LightChange& now) {
  const shared::Light& device = now.device;
  if (differs(before.color, device.color)) {
    write_color(to, "intensity", now);
  } else if (now.off) {
    to["intensity"] = 0.0f;
  }
  if (differs(before.range, device.range)) {
    to.erase("range");  // unlimited
    if (device.range > 0.0f) to["range"] = device.range;
  }
  if (device.type == shared::light_spot && has_other_cone(before, device)) write_cone(to, device);
}

std::vector<std::string_view> edited_members(const shared::Light& before, const LightChange& now) {
  const shared::Light& device = now.device;
  std::vector<std::string_view> edited;
  if (has_other_hue(before.color, device.color)) edited.push_back("color");
  if (now.off || differs(largest(before.color), largest(device.color))) {
    edited.push_back("intensity");
  }
  if (differs(before.range, device.range)) edited.push_back("range");
  if (device.type != shared::light_spot || !has_other_cone(before, device)) return edited;
  const Cone from = cone_of(before);
  const Cone to = cone_of(device);
  if (differs(float(from.inner), float(to.inner))) edited.push_back("spot/innerConeAngle");
  if (differs(float(from.outer), float(to.outer))) edited.push_back("spot/outerConeAngle");
  return edited;
}

void write_size(json& extras, const shared::Light& light) {
  if (light.type == shared::light_directional) {
    extras["angularDiameterDeg"] = 2.0f * glm::degrees(std::atan(light.radius));
  } else {
    extras["radius"] = light.radius;
  }
}

json new_area_light(const LightChange& light) {
  json made{{"shape", light.device.type == shared::light_disk ? "disk" : "rect"}};
  write_area_light(made, light);
  return made;
}

void write_area_light(json& to, const LightChange& light) {
  write_color(to, "radiance", light);
  if (light.device.type == shared::light_disk) {
    to["radius"] = light.device.radius;
  } else {
    to["width"] = 2.0f * light.device.half_width;
    to["height"] = 2.0f * light.device.half_height;
  }
}

}  // namespace heliograph::scene
