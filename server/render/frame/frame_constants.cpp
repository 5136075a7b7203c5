#include "render/frame/frame_constants.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>

#include "render/resources/environment/background.hpp"
#include "render/resources/ground_plane.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "render/resources/r2_sequence.hpp"

namespace heliograph::render {
namespace {

std::uint32_t flags(const protocol::Settings& settings, const scene::Camera& camera) {
  const auto bit = [](bool on, std::uint32_t flag) { return on ? flag : 0u; };
  return bit(settings.shadows.enabled, shared::frame_shadows) |
         bit(settings.indirect.enabled, shared::frame_indirect) |
         bit(settings.ambient.occlusion, shared::frame_ambient_occlusion) |
         bit(settings.lighting.direct, shared::frame_direct) |
         bit(settings.lighting.environment_diffuse, shared::frame_environment_diffuse) |
         bit(settings.lighting.environment_specular, shared::frame_environment_specular) |
         bit(settings.lighting.emissive, shared::frame_emissive) |
         bit(settings.lighting.light_grid, shared::frame_light_grid) |
         bit(settings.transmission.refraction, shared::frame_refraction) |
         bit(settings.environment.visible, shared::frame_environment_visible) |
         bit(camera.orthographic_height > 0.0f, shared::frame_orthographic);
}

/// Shifts the image by `offset` (in normalised device coordinates), perspective or not.
glm::mat4 jittered(glm::mat4 projection, const glm::vec2& offset) {
  glm::mat4 shift(1.0f);
  shift[3][0] = offset.x;
  shift[3][1] = offset.y;
  return shift * projection;
}

/// What depends on the environment; its intensity and rotation are there already.
void add_environment(shared::FrameConstants& constants, const EnvironmentView& environment) {
  constants.prefiltered_levels = environment.maps.prefiltered.desc().levels;
  for (std::size_t i = 0; i < 9; ++i) constants.irradiance[i] = environment.maps.irradiance[i];
  constants.sun_direction = {0.0f, 1.0f, 0.0f};
  constants.sun_radius = -1.0f;
  if (!environment.sun) return;
  const scene::Sun& sun = *environment.sun;
  const float c = constants.environment_cos, s = constants.environment_sin;
  const glm::vec3& d = sun.direction;
  constants.sun_direction = {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
  constants.sun_radius = std::tan(glm::radians(0.5f * sun.angular_diameter));
  constants.sun_irradiance = sun.irradiance * constants.environment_intensity;
  ++constants.light_count;
}

/// A thin lens: its aperture and what it focuses on (Potmesil and Chakravarty 1981).
void add_lens(shared::FrameConstants& constants, const scene::Camera& camera,
              const protocol::Settings::Lens& lens) {
  constants.focus_distance = 1.0f;
  if (!lens.depth_of_field || camera.orthographic_height > 0.0f) return;
  const float half_height = 0.5e-3f * lens.sensor_height;  // metres
  const float focal_length = half_height / std::tan(glm::radians(0.5f * camera.vertical_fov));
  const float chosen =
      lens.focus_distance > 0.0f ? lens.focus_distance : glm::distance(camera.eye, camera.target);
  constants.lens_radius = 0.5f * focal_length / lens.f_number;
  constants.focus_distance = std::max(chosen, camera.near_plane);
}

}  // namespace

glm::vec2 sample_jitter(std::uint32_t sample) {
  if (sample == 0) return glm::vec2(0.0f);
  return glm::vec2(r2_point(sample) - 0.5);
}

shared::FrameConstants make_frame_constants(const scene::Camera& camera,
                                            const protocol::Settings& settings,
                                            const MovingScene& scene, const FrameSizes& sizes,
                                            std::uint32_t sample,
                                            const shared::FrameConstants* before) {
  const glm::vec2 size(sizes.drawn.width, sizes.drawn.height);
  const float aspect =
      static_cast<float>(sizes.shown.width) / static_cast<float>(sizes.shown.height);
  const glm::vec2 offset =
      settings.antialiasing.jitter ? sample_jitter(sample) * 2.0f / size : glm::vec2(0.0f);
  const glm::mat4 view = scene::view_matrix(camera);
  const glm::mat4 projection = scene::projection_matrix(camera, aspect);
  shared::FrameConstants constants{};
  constants.view = view;
  constants.unjittered = projection * view;
  constants.view_projection = jittered(projection, offset) * view;
  constants.previous_unjittered = before ? before->unjittered : constants.unjittered;
  constants.previous_view = before ? before->view : view;
  constants.inverse_view = glm::inverse(view);
  const glm::vec2 scale{1.0f / projection[0][0], 1.0f / projection[1][1]};
  constants.unproject = {scale, -offset * scale};
  constants.eye = glm::vec4(camera.eye, 1.0f);
  constants.extent = {sizes.drawn.width, sizes.drawn.height};
  // Frames that are reconstructed at the size shown need the textures' detail of that size.
  constants.texture_footprint =
      static_cast<float>(sizes.drawn.height) / static_cast<float>(sizes.shown.height);
  constants.sample_index = sample;
  constants.seed = static_cast<std::uint32_t>(settings.sampling.seed);
  constants.light_count = static_cast<std::uint32_t>(scene.lights().size());
  constants.flags = flags(settings, camera);
  constants.history_invalid = before ? 0u : 1u;
  const float rotation = glm::radians(settings.environment.rotation);
  constants.environment_intensity = settings.environment.intensity;
  constants.background_intensity =
      shows_environment(settings.background) ? settings.environment.intensity : 1.0f;
  constants.environment_cos = std::cos(rotation);
  constants.environment_sin = std::sin(rotation);
  constants.ambient_radius = settings.ambient.radius;
  const float diameter = settings.shadows.angular_diameter_override;
  constants.exposure_factor = std::exp2(settings.exposure.compensation);
  constants.tone_map_curve = static_cast<std::uint32_t>(settings.tone_map.curve);
  constants.directional_light_radius =
      diameter < 0.0f ? -1.0f : std::tan(glm::radians(0.5f * diameter));
  add_lens(constants, camera, settings.lens);
  constants.ground = ground_plane(settings, scene);
  add_environment(constants, scene.environment().view(settings.environment.separate_sun));
  return constants;
}

shared::FrameConstants at_half_size(const shared::FrameConstants& frame) {
  shared::FrameConstants half = frame;
  half.extent = (frame.extent + 1u) / 2u;
  // A border that cuts squares in two lies inside the last of them.
  const glm::vec2 scale = 2.0f * glm::vec2(half.extent) / glm::vec2(frame.extent);
  const glm::vec2 slope(frame.unproject.x, frame.unproject.y);
  const glm::vec2 offset(frame.unproject.z, frame.unproject.w);
  half.unproject = {slope * scale, offset + slope * (scale - 1.0f)};
  return half;
}

FrameConstantsBuffers::FrameConstantsBuffers(const gpu::Device& device)
    : whole(device, "frame constants", sizeof(shared::FrameConstants),
            VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::Memory::upload),
      half(device, "frame constants at half size", sizeof(shared::FrameConstants),
           VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::Memory::upload) {}

void FrameConstantsBuffers::upload(const shared::FrameConstants& constants,
                                   const shared::FrameConstants& half_constants) {
  std::memcpy(whole.mapped(), &constants, sizeof constants);
  std::memcpy(half.mapped(), &half_constants, sizeof half_constants);
}

}  // namespace heliograph::render
