// Textures of KTX2 files that stay compressed on the device: what it reads, and what that saves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "render/api/renderer.hpp"
#include "render/resources/sampled_texture.hpp"
#include "scene/image/bc7/format.hpp"
#include "scene/image/ktx2/ktx2_decoder.hpp"
#include "scene/image/mipmaps.hpp"
#include "tests/gpu/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"
#include "tests/support/image_comparison.hpp"

namespace heliograph::test {
namespace {

/// The texel of a column and a row.
using Painter = std::function<std::array<double, 4>(double, double)>;

/// With all levels. `number` tells files apart, which nothing decodes here: texels are known.
scene::Image ktx2_image(std::uint32_t width, std::uint32_t height, bool srgb, std::uint8_t number,
                        const Painter& painter) {
  scene::Image image{"painted", width, height, scene::mip_level_count(width, height), srgb, {}};
  image.pixels.resize(scene::mip_chain_bytes(width, height));
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const std::array<double, 4> texel = painter(i % width, i / width);
    for (std::size_t c = 0; c < 4; ++c) {
      image.pixels[4 * i + c] =
          static_cast<std::uint8_t>(std::lround(std::clamp(texel[c], 0.0, 255.0)));
    }
  }
  scene::fill_mip_chain(image);
  image.file = std::make_shared<const std::vector<std::uint8_t>>(std::vector<std::uint8_t>{
      0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n', number});
  EXPECT_TRUE(scene::is_ktx2(*image.file));
  return image;
}

std::array<double, 4> slow_waves(double x, double y) {
  return {128 + 100 * std::sin(0.05 * x), 120 + 90 * std::cos(0.04 * y), 100 + 0.2 * (x + y), 255};
}

/// All texels of a level, as the device's sampler reads them.
std::vector<glm::vec4> read_level(const gpu::Image& image, std::uint32_t level) {
  const std::uint32_t width = std::max(image.desc().extent.width >> level, 1u);
  const std::uint32_t height = std::max(image.desc().extent.height >> level, 1u);
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.maxLod = VK_LOD_CLAMP_NONE;
  const gpu::Sampler sampler(device(), info);
  const gpu::ComputeProgram program(device(), shaders::sample_image);
  constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const VkDeviceSize bytes = width * height * sizeof(glm::vec4);
  gpu::FramePlan plan(device(), {1, 1});
  const auto places = plan.buffer("places", bytes, storage, gpu::Memory::upload);
  const auto colors = plan.buffer("colors", bytes, storage, gpu::Memory::readback);
  plan.pass("sample", program)
      .read(places)
      .read(plan.import(image, std::nullopt, sampler.handle()))
      .write(colors)
      .dispatch({width * height, 1});
  plan.compile();
  auto* const place = reinterpret_cast<glm::vec4*>(plan.get(places).mapped());
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const float column = static_cast<float>(i % width), row = static_cast<float>(i / width);
    place[i] = {(column + 0.5f) / static_cast<float>(width),
                (row + 0.5f) / static_cast<float>(height), static_cast<float>(level), 0.0f};
  }
  plan.execute();
  std::vector<glm::vec4> result(width * height);
  std::memcpy(result.data(), plan.get(colors).mapped(), bytes);
  return result;
}

/// Mean difference of what the device reads of a level and of an image's texels, of 255.
double mean_difference(const gpu::Image& read, const scene::Image& expected, std::uint32_t level) {
  const std::vector<glm::vec4> texels = read_level(read, level);
  const std::uint8_t* value = expected.pixels.data() + scene::level_offset(expected, level);
  double sum = 0.0;
  for (const glm::vec4& texel : texels) {
    for (int c = 0; c < 4; ++c) sum += std::abs(255.0 * texel[c] - *value++);
  }
  return sum / (4.0 * static_cast<double>(texels.size()));
}

class CompressedTexture : public testing::Test {
 protected:
  void SetUp() override {
    if (!device().samples_bc7()) GTEST_SKIP() << device().report().name << " does not read BC7";
  }
};

TEST_F(CompressedTexture, DeviceReadsEveryLevelOfAnySize) {
  for (const auto& [width, height] : {std::pair(37u, 22u), {64u, 64u}, {7u, 5u}, {130u, 3u}}) {
    const scene::Image image = ktx2_image(width, height, false, 0, slow_waves);
    const gpu::Image texture = render::make_sampled_texture(device(), image, image.pixels, true);
    ASSERT_EQ(texture.desc().format, VK_FORMAT_BC7_UNORM_BLOCK) << width << " x " << height;
    for (std::uint32_t level = 0; level < image.levels; ++level) {
      EXPECT_LT(mean_difference(texture, image, level), 3.0)
          << width << " x " << height << ", level " << level;
    }
  }
}

// The driver's tables of partitions and anchors are the specification's, whatever ours are.
TEST_F(CompressedTexture, DeviceReadsEveryPartition) {
  const scene::Image image = ktx2_image(4, 256, false, 0, [](double x, double y) {
    const unsigned set = scene::bc7::second_subsets[static_cast<std::size_t>(y) / 4];
    const unsigned texel = static_cast<unsigned>(x) + 4 * (static_cast<unsigned>(y) % 4);
    const double step = 5 * x + 7 * (texel / 4);
    return set >> texel & 1u ? std::array{40.0, 200 - step, 60 + step, 255.0}
                             : std::array{210 - step, 60.0, 150 + step, 255.0};
  });
  scene::Image first = image;
  first.levels = 1;
  const gpu::Image texture = render::make_sampled_texture(device(), first, first.pixels, true);
  ASSERT_EQ(texture.desc().format, VK_FORMAT_BC7_UNORM_BLOCK);
  EXPECT_LT(mean_difference(texture, first, 0), 1.5);
}

TEST_F(CompressedTexture, StaysRgbaWhereThatIsBetter) {
  const auto format_of = [](const scene::Image& image, bool compressed) {
    return render::make_sampled_texture(device(), image, image.pixels, compressed).desc().format;
  };
  scene::Image smooth = ktx2_image(32, 32, true, 0, slow_waves);
  EXPECT_EQ(format_of(smooth, true), VK_FORMAT_BC7_SRGB_BLOCK);
  EXPECT_EQ(format_of(smooth, false), VK_FORMAT_R8G8B8A8_SRGB) << "not wanted";
  smooth.file = std::make_shared<const std::vector<std::uint8_t>>(64, std::uint8_t{'P'});
  EXPECT_EQ(format_of(smooth, true), VK_FORMAT_R8G8B8A8_SRGB) << "of another file";
  smooth.file = nullptr;
  EXPECT_EQ(format_of(smooth, true), VK_FORMAT_R8G8B8A8_SRGB) << "of no file";

  RandomInputs random(5);
  const auto grain = [&](double strength) {
    return [&random, strength](double, double) {
      const auto value = [&] { return 128.0 + random.uniform(-1.0f, 1.0f) * strength; };
      return std::array{value(), value(), value(), 255.0};
    };
  };
  EXPECT_EQ(format_of(ktx2_image(64, 64, true, 0, grain(100)), true), VK_FORMAT_R8G8B8A8_SRGB);
  // What is lost of colours would be too much of normals.
  const Painter some = grain(10);
  EXPECT_EQ(format_of(ktx2_image(64, 64, true, 0, some), true), VK_FORMAT_BC7_SRGB_BLOCK);
  EXPECT_EQ(format_of(ktx2_image(64, 64, false, 0, some), true), VK_FORMAT_R8G8B8A8_UNORM);
}

TEST_F(CompressedTexture, IsForGpusUnlessItIsAskedFor) {
  EXPECT_EQ(engine().parts().compressed_textures, !device().is_cpu());
  const auto compresses = [](bool as_gpu, render::CompressedTextures wanted) {
    render::Engine made({.device = device().report().name,
                         .validation = true,
                         .as_gpu = as_gpu,
                         .compressed_textures = wanted});
    return made.parts().compressed_textures;
  };
  EXPECT_TRUE(compresses(true, render::CompressedTextures::automatic));
  EXPECT_TRUE(compresses(false, render::CompressedTextures::on));
  EXPECT_FALSE(compresses(true, render::CompressedTextures::off));
}

/// A ball and a floor with KTX2 textures for colours, normals and roughness.
std::shared_ptr<const scene::Scene> ktx2_scene() {
  constexpr std::uint32_t side = 256;
  scene::Scene textures;
  const auto add = [&](bool srgb, const Painter& painter) {
    const auto number = static_cast<std::uint32_t>(textures.images.size());
    textures.images.push_back(
        ktx2_image(side, side, srgb, static_cast<std::uint8_t>(number), painter));
    textures.textures.push_back({number, {}});
    return number;
  };
  shared::Material material = surface({1, 1, 1}, 1.0f, 1.0f);
  material.base_color_texture.texture = add(true, slow_waves);
  material.normal_texture.texture = add(false, [](double x, double y) {
    return std::array{128 + 30 * std::sin(0.1 * x), 128 + 30 * std::sin(0.12 * y), 250.0, 255.0};
  });
  material.metallic_roughness_texture.texture = add(false, [](double x, double y) {
    return std::array{255.0, 120 + 80 * std::sin(0.03 * (x + y)), x < 100 ? 255.0 : 0.0, 255.0};
  });
  SceneBuilder builder;
  builder.place(builder.add_sphere(0.8f, material));
  builder.place(builder.add_quad({{{-3, -1, 2}, {3, -1, 2}, {3, -1, -4}, {-3, -1, -4}}}, material));
  builder.add_sun({0.3f, -0.8f, -0.6f}, {2, 2, 2}, 0.5f);
  scene::Scene scene = *builder.build();
  scene.images = std::move(textures.images);
  scene.textures = std::move(textures.textures);
  return std::make_shared<const scene::Scene>(std::move(scene));
}

struct RenderedScene {
  render::Frame frame;
  std::uint64_t bytes = 0;  // of the scene on the device
  std::uint64_t messages = 0;
};

/// As on a GPU, whatever the device is.
RenderedScene render_with(const std::shared_ptr<const scene::Scene>& scene,
                          render::CompressedTextures compressed) {
  render::Engine engine({.device = device().report().name,
                         .validation = true,
                         .as_gpu = true,
                         .compressed_textures = compressed});
  RenderedScene rendered;
  {
    render::Renderer renderer(engine);
    protocol::Settings settings = without_indirect();
    settings.gbuffer.source = protocol::PrimaryVisibility::raster;
    settings.antialiasing.temporal = false;
    EXPECT_TRUE(renderer.set_settings(settings));
    renderer.set_size(160, 120);
    const auto resources =
        engine.upload(scene, heliograph::scene::constant_environment(glm::vec3(0.5f)));
    renderer.set_scene(resources);
    renderer.set_camera(look({0, 0.6f, 3.2f}, {0, -0.2f, 0}));
    do rendered.frame = renderer.render();
    while (rendered.frame.samples < 8);
    rendered.bytes = render::memory_bytes(*resources);
  }
  rendered.messages = engine.validation_messages();
  return rendered;
}

TEST_F(CompressedTexture, FramesAreAlikeAndTakeAQuarterOfTheMemory) {
  const auto scene = ktx2_scene();
  const RenderedScene whole = render_with(scene, render::CompressedTextures::off);
  const RenderedScene compressed = render_with(scene, render::CompressedTextures::automatic);
  expect_similar("compressed_textures", whole.frame, compressed.frame, 0.7, 0.99);
  EXPECT_NE(whole.frame.rgba, compressed.frame.rgba) << "the textures were the same";
  std::uint64_t rgba_bytes = 0;
  for (const scene::Image& image : scene->images) rgba_bytes += image.pixels.size();
  const double saved = static_cast<double>(whole.bytes) - static_cast<double>(compressed.bytes);
  EXPECT_NEAR(saved / static_cast<double>(rgba_bytes), 0.75, 0.01);
  EXPECT_EQ(whole.messages + compressed.messages, 0u);
}

}  // namespace
}  // namespace heliograph::test
