#include "render/resources/ground_plane.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/resources/environment/upper_light.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "render/resources/r2_sequence.hpp"

namespace heliograph::render {
namespace {

constexpr std::size_t most_sources = 64;    // the brightest of them
constexpr std::size_t least_of_source = 4;  // points of each

/// A light, or the environment, with the luminance that it sends to the ground's middle.
struct Source {
  const shared::Light* light;  // null: the environment
  float irradiance;
};

/// Place number `i` in a disk of radius 1.
glm::vec2 in_disk(std::size_t i) {
  const glm::dvec2 point = r2_point(i);
  const double radius = std::sqrt(point.x), angle = 2.0 * std::numbers::pi * point.y;
  return glm::vec2(radius * std::cos(angle), radius * std::sin(angle));
}

glm::vec2 in_square(std::size_t i) {
  return glm::vec2(2.0 * r2_point(i) - 1.0);
}

glm::vec3 across(const glm::vec3& direction) {
  const glm::vec3 other = std::abs(direction.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  return glm::normalize(glm::cross(other, direction));
}

float area_of(const shared::Light& light) {
  if (light.type == shared::light_rectangle) return 4.0f * light.half_width * light.half_height;
  return std::numbers::pi_v<float> * light.radius * light.radius;
}

shared::Light sun_light(const shared::FrameConstants& frame) {
  shared::Light light{};
  light.type = shared::light_directional;
  light.direction = -frame.sun_direction;
  light.color = frame.sun_irradiance;
  light.radius = frame.sun_radius;
  return light;
}

/// Point number `i` of a light; its weight is that of the whole light.
shared::GroundLight point_of(const shared::Light& light, const glm::vec3& middle, std::size_t i) {
  shared::GroundLight point{};
  point.weight = static_cast<float>(brightness_of(light.color));
  if (light.type == shared::light_directional) {
    const glm::vec3 to_light = -light.direction, tangent = across(to_light);
    const glm::vec2 at = in_disk(i) * light.radius;
    point.kind = shared::ground_light_far;
    point.place = glm::normalize(to_light + at.x * tangent + at.y * glm::cross(to_light, tangent));
    point.weight *= std::max(point.place.y, 0.0f);
    return point;
  }
  point.range = light.range;
  point.axis = light.direction;
  if (light.type >= shared::light_rectangle) {
    const bool rectangle = light.type == shared::light_rectangle;
    const glm::vec2 half =
        rectangle ? glm::vec2(light.half_width, light.half_height) : glm::vec2(light.radius);
    const glm::vec2 at = (rectangle ? in_square(i) : in_disk(i)) * half;
    point.kind = shared::ground_light_area;
    point.place =
        light.position + at.x * light.tangent + at.y * glm::cross(light.direction, light.tangent);
    point.weight *= area_of(light);
    point.scale = 1.0f;
    return point;
  }
  const glm::vec3 away = glm::normalize(light.position - middle), tangent = across(away);
  const glm::vec2 at = in_disk(i) * light.radius;
  point.kind = shared::ground_light_point;
  point.place = light.position + at.x * tangent + at.y * glm::cross(away, tangent);
  point.scale = light.type == shared::light_spot ? light.spot_scale : 0.0f;
  point.offset = light.type == shared::light_spot ? light.spot_offset : 1.0f;
  return point;
}

float irradiance_of(const shared::Light& light, const glm::vec3& middle) {
  const shared::GroundLight point = point_of(light, middle, 0);
  if (point.kind == shared::ground_light_far) return point.weight;
  const glm::vec3 to_light = point.place - middle;
  const float squared = std::max(glm::dot(to_light, to_light), 1e-8f);
  return point.weight * std::max(to_light.y, 0.0f) / (squared * std::sqrt(squared));
}

/// How many of shared::ground_lights points each source gets.
std::vector<std::size_t> shares(std::span<const Source> sources) {
  float total = 0.0f;
  for (const Source& source : sources) total += source.irradiance;
  const std::size_t divided = shared::ground_lights - least_of_source * sources.size();
  std::vector<std::size_t> counts;
  std::size_t given = 0;
  for (const Source& source : sources) {
    const float part = source.irradiance / total * static_cast<float>(divided);
    counts.push_back(least_of_source + static_cast<std::size_t>(part));
    given += counts.back();
  }
  // The brightest, which comes first, has what rounding leaves.
  counts.front() += shared::ground_lights - given;
  return counts;
}

}  // namespace

bool catches_shadows(const protocol::Settings& settings, const MovingScene& scene) {
  if (scene.resources().scene->bounds.empty()) return false;
  const protocol::GroundUse use = settings.background.ground;
  if (use == protocol::GroundUse::by_scene) return scene.lit_by_studio_alone();
  return use == protocol::GroundUse::on;
}

glm::vec4 ground_plane(const protocol::Settings& settings, const MovingScene& scene) {
  if (!catches_shadows(settings, scene)) return glm::vec4(0.0f);
  const scene::Bounds& bounds = scene.resources().scene->bounds;
  const glm::vec3 size = bounds.maximum - bounds.minimum, middle = bounds.center();
  const float half_side = 0.75f * glm::length(glm::vec2(size.x, size.z)) + 1.25f * size.y;
  return {middle.x, bounds.minimum.y, middle.z, half_side};
}

void choose_ground_lights(const shared::FrameConstants& frame, const UpperLight& sky,
                          std::span<const shared::Light> scene_lights,
                          std::span<shared::GroundLight> lights) {
  const glm::vec3 middle(frame.ground);
  std::vector<shared::Light> all(scene_lights.begin(), scene_lights.end());
  if (frame.sun_radius >= 0.0f) all.push_back(sun_light(frame));
  for (shared::Light& light : all) {
    if (light.type != shared::light_directional || frame.directional_light_radius < 0.0f) continue;
    light.radius = frame.directional_light_radius;
  }

  std::vector<Source> sources{{nullptr, sky.irradiance * frame.environment_intensity}};
  for (const shared::Light& light : all) sources.push_back({&light, irradiance_of(light, middle)});
  std::erase_if(sources, [](const Source& source) { return !(source.irradiance > 0.0f); });
  std::ranges::stable_sort(sources, std::ranges::greater(), &Source::irradiance);
  if (sources.size() > most_sources) sources.resize(most_sources);
  std::ranges::fill(lights, shared::GroundLight{});
  if (sources.empty()) return;

  const std::vector<std::size_t> counts = shares(sources);
  const float c = frame.environment_cos, s = frame.environment_sin;
  std::size_t at = 0;
  for (std::size_t k = 0; k < sources.size(); ++k) {
    for (std::size_t i = 0; i < counts[k]; ++i, ++at) {
      if (sources[k].light) {
        lights[at] = point_of(*sources[k].light, middle, i);
      } else {
        const glm::vec3& d = sky.directions[i * sky.directions.size() / counts[k]];
        lights[at].place = {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
        lights[at].weight = sources[k].irradiance;
      }
      lights[at].weight /= static_cast<float>(counts[k]);
    }
  }
}

}  // namespace heliograph::render
