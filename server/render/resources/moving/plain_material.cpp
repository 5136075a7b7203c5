#include "render/resources/moving/plain_material.hpp"

#include "shaders/shared/shading.h"

namespace heliograph::render {

shared::Material plain_material(const shared::Material& material) {
  constexpr std::uint32_t kept = shared::material_alpha_mask | shared::material_double_sided;
  shared::Material plain = material;
  plain.flags &= kept;
  const bool has_holes = (plain.flags & shared::material_alpha_mask) != 0;
  plain.base_color =
      glm::vec4(glm::vec3(shared::clay_albedo), has_holes ? plain.base_color.w : 1.0f);
  plain.emissive = glm::vec3(0.0f);
  plain.metallic = 0.0f;
  plain.roughness = shared::clay_roughness;
  plain.ior = 1.5f;
  plain.layer = 0;
  if (!has_holes) {
    plain.passing = 0.0f;
    plain.alpha_mask = shared::no_texture;
    plain.base_color_texture.texture = shared::no_texture;
  }
  for (shared::TextureSlot* const slot : {&plain.metallic_roughness_texture, &plain.normal_texture,
                                          &plain.occlusion_texture, &plain.emissive_texture}) {
    slot->texture = shared::no_texture;
  }
  return plain;
}

}  // namespace heliograph::render
