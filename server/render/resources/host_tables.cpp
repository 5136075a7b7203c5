#include "render/resources/host_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/resources/moving/moving_scene.hpp"
#include "render/resources/scene_resources.hpp"

namespace heliograph::render::kernels {
namespace {

static_assert(sizeof(Slot) == 16 * 4 && sizeof(Material) == (16 + 5 * 16) * 4 &&
              sizeof(Layer) == (36 + 14 * 16) * 4);

bool same_texels(const shared::TextureSlot& a, const shared::TextureSlot& b) {
  return a.texture == b.texture && a.uv_set == b.uv_set &&
         glm::vec3(a.transform_row0) == glm::vec3(b.transform_row0) &&
         glm::vec3(a.transform_row1) == glm::vec3(b.transform_row1);
}

Slot make_slot(const shared::TextureSlot& from, std::span<const shared::HeapTexture> textures,
               std::span<const std::uint32_t> first_level) {
  Slot slot{};
  slot.width = slot.height = slot.levels = 1;
  slot.first_level = first_level.back();
  if (from.texture == shared::no_texture) return slot;
  const shared::HeapTexture& texture = textures[from.texture];
  slot.row0 = from.transform_row0;
  slot.row1 = from.transform_row1;
  const float area = std::abs(slot.row0.x * slot.row1.y - slot.row0.y * slot.row1.x) *
                     static_cast<float>(texture.width) * static_cast<float>(texture.height);
  slot.lod = 0.5f * std::log2(std::max(area, 1e-30f));
  slot.uv_set = from.uv_set;
  slot.flags = texture.flags | slot_used;
  slot.width = texture.width;
  slot.height = texture.height;
  slot.levels = texture.levels;
  slot.wrap_s = texture.wrap_s;
  slot.wrap_t = texture.wrap_t;
  slot.first_level = first_level[from.texture];
  return slot;
}

/// Whether two used slots are read at the same texels of images of the same size.
bool same_place(const Slot& a, const Slot& b) {
  const auto filter = [](const Slot& slot) { return slot.flags & ~shared::texture_srgb; };
  return a.row0 == b.row0 && a.row1 == b.row1 && a.uv_set == b.uv_set && a.width == b.width &&
         a.height == b.height && a.levels == b.levels && a.wrap_s == b.wrap_s &&
         a.wrap_t == b.wrap_t && filter(a) == filter(b);
}

/// Copies the slots of one record.
struct SlotMaker {
  std::span<const shared::HeapTexture> textures;
  std::span<const std::uint32_t> first_level;

  Slot make(const shared::TextureSlot& from, std::uint32_t& uses) const {
    const Slot made = make_slot(from, textures, first_level);
    if (made.flags & slot_used) uses |= uses_textures | (made.uv_set ? uses_second_uv : 0u);
    return made;
  }
};

/// Marks the slots that are read where the first is.
void share_place(const Slot& first, std::initializer_list<Slot*> others) {
  for (Slot* const other : others) {
    const bool both = (first.flags & other->flags & slot_used) != 0;
    if (both && same_place(first, *other)) other->flags |= slot_shares_place;
  }
}

Material make_material(const shared::Material& from, const SlotMaker& slots) {
  shared::TextureSlot no_slot{};
  no_slot.texture = shared::no_texture;
  Material to{};
  to.base_color = from.base_color;
  to.emissive = from.emissive;
  to.alpha_cutoff = from.alpha_cutoff;
  to.metallic = from.metallic;
  to.roughness = from.roughness;
  to.normal_scale = from.normal_scale;
  to.occlusion_strength = from.occlusion_strength;
  to.flags = from.flags;
  to.base_color_slot = slots.make(from.base_color_texture, to.uses);
  to.metallic_roughness_slot = slots.make(from.metallic_roughness_texture, to.uses);
  to.occlusion_slot = slots.make(from.occlusion_texture, to.uses);
  to.normal_slot = slots.make(from.normal_texture, to.uses);
  const bool shines = from.emissive != glm::vec3(0.0f);
  to.emissive_slot = slots.make(shines ? from.emissive_texture : no_slot, to.uses);
  share_place(to.base_color_slot, {&to.metallic_roughness_slot, &to.occlusion_slot, &to.normal_slot,
                                   &to.emissive_slot});
  if (same_texels(from.occlusion_texture, from.metallic_roughness_texture)) {
    to.occlusion_slot.flags |= slot_repeats;
  }
  return to;
}

Layer make_layer(const shared::MaterialLayer& from, const SlotMaker& slots) {
  Layer to{};
  to.specular_color = from.specular_color;
  to.specular = from.specular;
  to.sheen = from.sheen;
  to.sheen_roughness = from.sheen_roughness;
  to.absorption = from.absorption;
  to.transmission = from.transmission;
  to.dielectric = from.dielectric;
  to.coat = from.coat;
  to.coat_roughness = from.coat_roughness;
  to.coat_normal_scale = from.coat_normal_scale;
  to.iridescence = from.iridescence;
  to.film_ior = from.film_ior;
  to.film_least = from.film_least;
  to.film_thickness = from.film_thickness;
  to.anisotropy = from.anisotropy;
  to.grain_x = from.grain_x;
  to.grain_y = from.grain_y;
  to.dispersion = from.dispersion;
  to.attenuation = from.attenuation;
  to.refraction = from.refraction;
  to.diffuse_tint = from.diffuse_tint;
  to.diffuse_transmission = from.diffuse_transmission;
  to.coat_slot = slots.make(from.coat_texture, to.uses);
  to.coat_roughness_slot = slots.make(from.coat_roughness_texture, to.uses);
  to.coat_normal_slot = slots.make(from.coat_normal_texture, to.uses);
  to.specular_slot = slots.make(from.specular_texture, to.uses);
  to.specular_color_slot = slots.make(from.specular_color_texture, to.uses);
  to.sheen_color_slot = slots.make(from.sheen_color_texture, to.uses);
  to.sheen_roughness_slot = slots.make(from.sheen_roughness_texture, to.uses);
  to.transmission_slot = slots.make(from.transmission_texture, to.uses);
  to.thickness_slot = slots.make(from.thickness_texture, to.uses);
  to.iridescence_slot = slots.make(from.iridescence_texture, to.uses);
  to.film_slot = slots.make(from.film_texture, to.uses);
  to.anisotropy_slot = slots.make(from.anisotropy_texture, to.uses);
  to.diffuse_transmission_slot = slots.make(from.diffuse_transmission_texture, to.uses);
  to.diffuse_tint_slot = slots.make(from.diffuse_tint_texture, to.uses);
  share_place(to.coat_slot,
              {&to.coat_roughness_slot, &to.coat_normal_slot, &to.specular_slot,
               &to.specular_color_slot, &to.sheen_color_slot, &to.sheen_roughness_slot,
               &to.transmission_slot, &to.thickness_slot, &to.iridescence_slot, &to.film_slot,
               &to.anisotropy_slot, &to.diffuse_transmission_slot, &to.diffuse_tint_slot});
  return to;
}

/// The texel of a cube beyond the rim of a face: the neighbour's nearest. `x` and `y` lie in
/// [-1, size], at most one of them outside.
glm::ivec3 texel_around(int face, int x, int y, int size) {
  const auto coordinate = [size](int i) {
    const float p = (static_cast<float>(i) + 0.5f) / static_cast<float>(size) * 2.0f - 1.0f;
    return std::clamp(p, -1.0f, 1.0f);  // a texel outside stands on the edge
  };
  const float u = coordinate(x), v = coordinate(y);
  // Vulkan's faces: which axis leads, and where u and v point.
  const std::array<glm::vec3, 6> directions{glm::vec3(1, -v, -u), {-1, -v, u}, {u, 1, v},
                                            {u, -1, -v},          {u, -v, 1},  {-u, -v, -1}};
  const glm::vec3 d = directions[static_cast<std::size_t>(face)];
  // On the edge two axes lead: the one that is not this face's is the neighbour's.
  int axis = face / 2;
  if (x < 0 || x >= size || y < 0 || y >= size) {
    for (int other = 0; other < 3; ++other) {
      if (other != face / 2 && std::abs(d[other]) == 1.0f) axis = other;
    }
  }
  const int target = 2 * axis + (d[axis] < 0.0f ? 1 : 0);
  const std::array<glm::vec2, 6> positions{glm::vec2(-d.z, -d.y), {d.z, -d.y}, {d.x, d.z},
                                           {d.x, -d.z},           {d.x, -d.y}, {-d.x, -d.y}};
  const glm::vec2 at = positions[static_cast<std::size_t>(target)] * 0.5f + 0.5f;
  const auto texel = [size](float p) {
    return std::clamp(static_cast<int>(p * static_cast<float>(size)), 0, size - 1);
  };
  return {texel(at.x), texel(at.y), target};
}

/// Six faces with their rims from six without.
void add_level(const std::array<std::vector<glm::vec4>, 6>& faces, int size,
               std::vector<float>& cube) {
  const auto texel = [&](int face, int x, int y) {
    const glm::ivec3 at = texel_around(face, x, y, size);
    return faces[static_cast<std::size_t>(at.z)][static_cast<std::size_t>(at.y * size + at.x)];
  };
  const auto outside = [size](int i) { return i < 0 || i >= size; };
  for (int face = 0; face < 6; ++face) {
    for (int y = -1; y <= size; ++y) {
      for (int x = -1; x <= size; ++x) {
        glm::vec4 color;
        if (outside(x) && outside(y)) {
          // Three texels meet at a corner of a cube: there is no fourth.
          const int in_x = std::clamp(x, 0, size - 1), in_y = std::clamp(y, 0, size - 1);
          color = (texel(face, in_x, in_y) + texel(face, x, in_y) + texel(face, in_x, y)) / 3.0f;
        } else {
          color = texel(face, x, y);
        }
        cube.insert(cube.end(), {color.x, color.y, color.z, color.w});
      }
    }
  }
}

std::vector<glm::vec4> download_face(const gpu::Image& image, std::uint32_t face,
                                     std::uint32_t level) {
  const std::vector<std::byte> bytes = image.download_level(level, face);
  std::vector<glm::vec4> texels(bytes.size() / sizeof(glm::vec4));
  std::memcpy(texels.data(), bytes.data(), bytes.size());
  return texels;
}

}  // namespace

MaterialTable make_material_table(std::span<const shared::Material> materials,
                                  std::span<const shared::MaterialLayer> layers,
                                  std::span<const shared::HeapTexture> textures) {
  MaterialTable table;
  std::vector<std::uint32_t> first_level;
  for (const shared::HeapTexture& texture : textures) {
    first_level.push_back(static_cast<std::uint32_t>(table.levels.size()));
    std::uint32_t first = texture.first_texel;
    // One more than there are: the last level's next is never read, but looked up.
    for (std::uint32_t level = 0; level <= texture.levels; ++level) {
      table.levels.push_back(first);
      first += std::max(texture.width >> level, 1u) * std::max(texture.height >> level, 1u);
    }
  }
  first_level.push_back(static_cast<std::uint32_t>(table.levels.size()));
  table.levels.insert(table.levels.end(), {0, 0});  // of slots without a texture
  const SlotMaker slots{textures, first_level};
  for (const shared::MaterialLayer& from : layers) table.layers.push_back(make_layer(from, slots));
  for (const shared::Material& from : materials) {
    Material made = make_material(from, slots);
    if (!table.layers.empty()) {
      made.layer = from.layer;
      made.passing = from.passing;
      made.uses |= table.layers[from.layer].uses;
    }
    table.materials.push_back(made);
  }
  return table;
}

SceneView view_scene(const SceneResources& scene, const tracing::SceneTables& tables,
                     const MovingScene& moving) {
  const auto mapped = [](const gpu::Buffer& buffer) { return buffer.mapped(); };
  const MaterialTable& made = moving.host_materials();
  return {reinterpret_cast<const shared::Vertex*>(mapped(tables.vertices)),
          reinterpret_cast<const std::uint32_t*>(mapped(tables.indices)),
          reinterpret_cast<const shared::Mesh*>(mapped(tables.meshes)),
          reinterpret_cast<const shared::Instance*>(mapped(tables.instances)),
          made.materials.data(),
          made.layers.data(),
          made.levels.data(),
          reinterpret_cast<const std::uint32_t*>(mapped(scene.texture_heap.texels)),
          reinterpret_cast<const shared::Vertex*>(mapped(moving.previous_vertices())),
          view_emissive(moving.emissive())};
}

RadianceMap view_map(const scene::Environment& environment) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  return {&environment.radiance.front().x, static_cast<int>(environment.width),
          static_cast<int>(environment.height)};
}

Environment copy_environment(const scene::Environment& map, const gpu::Image& prefiltered) {
  Environment copy;
  copy.map = {map.width, map.height, {}};
  copy.map.values.resize(map.radiance.size() * 3);
  std::memcpy(copy.map.values.data(), map.radiance.data(), map.radiance.size() * sizeof(glm::vec3));
  const auto size_of = [&](std::uint32_t level) {
    return std::max(prefiltered.desc().extent.width >> level, 1u);
  };
  std::size_t floats = 0;
  for (std::uint32_t level = 0; level < prefiltered.desc().levels; ++level) {
    const std::size_t side = size_of(level) + 2;
    floats += 6 * 4 * side * side;
  }
  copy.cube.reserve(floats);
  for (std::uint32_t level = 0; level < prefiltered.desc().levels; ++level) {
    const std::uint32_t size = size_of(level);
    std::array<std::vector<glm::vec4>, 6> faces;
    for (std::uint32_t face = 0; face < 6; ++face) {
      faces[face] = download_face(prefiltered, face, level);
    }
    copy.levels.push_back({size, static_cast<std::uint32_t>(copy.cube.size())});
    add_level(faces, static_cast<int>(size), copy.cube);
  }
  return copy;
}

}  // namespace heliograph::render::kernels
