#include "render/resources/emissive/emission_means.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/image/mipmaps.hpp"

namespace heliograph::render {
namespace {

/// Each side of a triangle is divided into so many, each of the parts read once.
constexpr int side_parts = 4;

std::array<float, 256> make_decoding(bool srgb) {
  std::array<float, 256> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float e = static_cast<float>(i) / 255.0f;
    const bool straight = !srgb || e <= 0.04045f;
    values[i] = srgb && straight ? e / 12.92f
                : straight       ? e
                                 : std::pow((e + 0.055f) / 1.055f, 2.4f);
  }
  return values;
}

std::uint32_t wrapped(float texel, std::uint32_t size, std::uint32_t mode) {
  const float length = static_cast<float>(size);
  if (mode == shared::wrap_repeat) texel -= length * std::floor(texel / length);
  if (mode == shared::wrap_mirror) {
    texel -= 2.0f * length * std::floor(texel / (2.0f * length));
    texel = std::min(texel, 2.0f * length - texel);
  }
  return static_cast<std::uint32_t>(std::clamp(texel, 0.0f, length - 1.0f));
}

/// An image with its levels, as a sampler wraps it.
class Texels {
 public:
  Texels(const scene::Image& image, const scene::Sampler& sampler,
         std::span<const std::uint8_t> pixels)
      : size_(image.width, image.height),
        first_level_(scene::first_level_in(image, pixels.size())),
        sampler_(sampler),
        decoding_(make_decoding(image.srgb)) {
    std::size_t first = 0;
    for (std::uint32_t level = first_level_; level < image.levels; ++level) {
      const glm::uvec2 size(std::max(image.width >> level, 1u),
                            std::max(image.height >> level, 1u));
      levels_.push_back({size, pixels.data() + first});
      first += std::size_t{4} * size.x * size.y;
    }
  }

  /// Of the whole image.
  glm::vec2 size() const { return size_; }

  /// The level at hand whose texels are not smaller than `step` of the largest level's.
  std::size_t level_of(float step) const {
    const int level = step > 1.0f ? static_cast<int>(std::ceil(std::log2(step))) : 0;
    const int at_hand = std::max(level - static_cast<int>(first_level_), 0);
    return std::min(static_cast<std::size_t>(at_hand), levels_.size() - 1);
  }

  glm::vec3 nearest(const glm::vec2& uv, std::size_t number) const {
    const Level& level = levels_[number];
    const std::size_t x =
        wrapped(uv.x * static_cast<float>(level.size.x), level.size.x, sampler_.wrap_s);
    const std::size_t y =
        wrapped(uv.y * static_cast<float>(level.size.y), level.size.y, sampler_.wrap_t);
    const std::uint8_t* const texel = level.pixels + 4 * (y * level.size.x + x);
    return {decoding_[texel[0]], decoding_[texel[1]], decoding_[texel[2]]};
  }

 private:
  struct Level {
    glm::uvec2 size;
    const std::uint8_t* pixels;
  };
  glm::vec2 size_;
  std::uint32_t first_level_;
  const scene::Sampler& sampler_;
  std::array<float, 256> decoding_;
  std::vector<Level> levels_;
};

/// In the middles of equal parts of the triangle, from a level that leaves no texel out.
glm::vec3 mean_texel(const Texels& texels, const std::array<glm::vec2, 3>& uv) {
  const glm::vec2 a = uv[1] - uv[0], b = uv[2] - uv[0], c = uv[2] - uv[1];
  const glm::vec2 size = texels.size();
  const float longest =
      std::max({glm::length(a * size), glm::length(b * size), glm::length(c * size)});
  if (!std::isfinite(longest)) return glm::vec3(0.0f);
  const int parts = longest <= 1.0f ? 1 : side_parts;
  const float step = 1.0f / static_cast<float>(parts);
  const std::size_t level = texels.level_of(longest * step);
  glm::vec3 sum(0.0f);
  for (int i = 0; i < parts; ++i) {
    for (int j = 0; i + j < parts; ++j) {
      const glm::vec2 corner =
          uv[0] + step * (static_cast<float>(i) * a + static_cast<float>(j) * b);
      sum += texels.nearest(corner + (a + b) * (step / 3.0f), level);
      if (i + j + 1 == parts) continue;
      sum += texels.nearest(corner + (a + b) * (step * 2.0f / 3.0f), level);
    }
  }
  return sum * (step * step);
}

glm::vec2 slot_uv(const shared::TextureSlot& slot, const shared::Vertex& vertex) {
  const glm::vec3 uv(slot.uv_set == 0 ? vertex.uv0 : vertex.uv1, 1.0f);
  return {glm::dot(glm::vec3(slot.transform_row0), uv),
          glm::dot(glm::vec3(slot.transform_row1), uv)};
}

}  // namespace

EmissionMeans::EmissionMeans(const scene::Scene& scene) : means_(scene.meshes.size()) {}

void EmissionMeans::add(const scene::Scene& scene, std::size_t image,
                        std::span<const std::uint8_t> pixels) {
  for (std::size_t number = 0; number < scene.meshes.size(); ++number) {
    const scene::Mesh& mesh = scene.meshes[number];
    const shared::TextureSlot& slot = scene.materials[mesh.material].emissive_texture;
    if (slot.texture == shared::no_texture) continue;
    const scene::Texture& texture = scene.textures[slot.texture];
    if (texture.image != image) continue;
    const Texels texels(scene.images[image], texture.sampler, pixels);
    std::vector<glm::vec3>& means = means_[number];
    means.resize(mesh.indices.size() / 3);
    tbb::parallel_for(std::size_t{0}, means.size(), [&](std::size_t triangle) {
      std::array<glm::vec2, 3> uv;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        uv[corner] = slot_uv(slot, mesh.vertices[mesh.indices[3 * triangle + corner]]);
      }
      means[triangle] = mean_texel(texels, uv);
    });
  }
}

std::uint64_t EmissionMeans::bytes() const {
  std::uint64_t sum = 0;
  for (const auto& means : means_) sum += means.size() * sizeof(glm::vec3);
  return sum;
}

}  // namespace heliograph::render
