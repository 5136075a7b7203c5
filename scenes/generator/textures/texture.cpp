#include "scenes/generator/textures/texture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace heliograph::scenes {
namespace {

using TexelField = std::vector<float>;

std::uint8_t to_byte(float value) {
  return std::uint8_t(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

int wrap_texel(int value, int size) {
  return (value % size + size) % size;
}

// Mean over a (2 * radius + 1)^2 window that runs over the borders, as one pass in x and one in y.
TexelField blurred(const TexelField& field, int size, int radius) {
  const auto pass = [&](const TexelField& in, int step_x, int step_y) {
    TexelField out(in.size());
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        float sum = 0.0f;
        for (int k = -radius; k <= radius; ++k) {
          sum += in[std::size_t(wrap_texel(y + k * step_y, size) * size +
                                wrap_texel(x + k * step_x, size))];
        }
        out[std::size_t(y * size + x)] = sum / float(2 * radius + 1);
      }
    }
    return out;
  };
  return pass(pass(field, 1, 0), 0, 1);
}

Image normal_map(const TexelField& height, int size, float pixel_width) {
  Image image(size, size, 3);
  const auto at = [&](int x, int y) {
    return height[std::size_t(wrap_texel(y, size) * size + wrap_texel(x, size))];
  };
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float right = (at(x + 1, y) - at(x - 1, y)) / (2.0f * pixel_width);
      const float down = (at(x, y + 1) - at(x, y - 1)) / (2.0f * pixel_width);
      const glm::vec3 normal = glm::normalize(glm::vec3(-right, down, 1.0f));
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = to_byte(0.5f + 0.5f * normal[c]);
    }
  }
  return image;
}

// Points below their surroundings see less of the sky: occlusion falls with the depth relative to
// the width of the hollow.
TexelField cavity_occlusion(const TexelField& height, int size, float pixel_width) {
  const int radius = std::max(2, size / 32);
  const TexelField mean = blurred(height, size, radius);
  TexelField occlusion(height.size());
  for (std::size_t i = 0; i < height.size(); ++i) {
    const float depth = std::max(0.0f, mean[i] - height[i]);
    occlusion[i] = 1.0f / (1.0f + 4.0f * depth / (pixel_width * float(radius)));
  }
  return occlusion;
}

}  // namespace

TextureSet bake(const TextureRecipe& recipe, int wanted_size) {
  const int size = std::max(8, wanted_size / recipe.resolution_divisor);
  const float pixel_width = recipe.width / float(size);
  TextureSet set{Image(size, size, recipe.masked ? 4 : 3), {}, Image(size, size, 3)};
  TexelField height(std::size_t(size) * std::size_t(size));
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const SurfaceSample sample = recipe.sample((glm::vec2(x, y) + 0.5f) / float(size));
      std::uint8_t* color = set.color.at(x, y);
      for (int c = 0; c < 3; ++c) color[c] = to_byte(sample.color[c]);
      if (recipe.masked) color[3] = to_byte(sample.alpha);
      set.surface.at(x, y)[1] = to_byte(sample.roughness);
      set.surface.at(x, y)[2] = to_byte(sample.metallic);
      height[std::size_t(y * size + x)] = sample.height;
    }
  }
  const TexelField occlusion = cavity_occlusion(height, size, pixel_width);
  for (std::size_t i = 0; i < occlusion.size(); ++i) {
    set.surface.pixels[3 * i] = to_byte(occlusion[i]);
  }
  set.normal = normal_map(height, size, pixel_width);
  return set;
}

}  // namespace heliograph::scenes
