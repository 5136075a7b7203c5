#include "render/resources/texture_heap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "scene/image/mipmaps.hpp"
#include "tests/gpu/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

/// Random texels, so that reading a wrong one shows.
scene::Image noise(std::uint32_t width, std::uint32_t height, bool srgb) {
  scene::Image image{"noise", width, height, scene::mip_level_count(width, height), srgb, {}};
  image.pixels.resize(scene::mip_chain_bytes(width, height));
  RandomInputs random(width);
  for (std::size_t i = 0; i < std::size_t{width} * height * 4; ++i) {
    image.pixels[i] = static_cast<std::uint8_t>(random.uniform(0.0f, 255.99f));
  }
  scene::fill_mip_chain(image);
  return image;
}

VkSamplerAddressMode address_mode(std::uint32_t wrap) {
  if (wrap == shared::wrap_clamp) return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  if (wrap == shared::wrap_mirror) return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
  return VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

VkSamplerCreateInfo sampler_info(const scene::Sampler& from) {
  const auto filter = [](scene::Filter f) {
    return f == scene::Filter::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  };
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = filter(from.magnify);
  info.minFilter = filter(from.minify);
  info.mipmapMode = from.mip_filter == scene::Filter::nearest ? VK_SAMPLER_MIPMAP_MODE_NEAREST
                                                              : VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.addressModeU = address_mode(from.wrap_s);
  info.addressModeV = address_mode(from.wrap_t);
  info.maxLod = from.mipmapped ? VK_LOD_CLAMP_NONE : 0.25f;
  return info;
}

/// The same texture coordinates read through the device's sampler.
std::vector<glm::vec4> sampled(const scene::Image& from, const scene::Sampler& sampler,
                               const std::vector<ShaderInput>& inputs) {
  gpu::ImageDesc desc{.name = "image", .extent = {from.width, from.height}};
  desc.format = from.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  desc.levels = from.levels;
  const gpu::Image image(device(), desc);
  image.upload(std::as_bytes(std::span(from.pixels)));
  const gpu::Sampler device_sampler(device(), sampler_info(sampler));
  const gpu::ComputeProgram program(device(), shaders::sample_image);
  constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const auto count = static_cast<std::uint32_t>(inputs.size());
  gpu::FramePlan plan(device(), {1, 1});
  const auto places =
      plan.buffer("coordinates", count * sizeof(glm::vec4), storage, gpu::Memory::upload);
  const auto colors =
      plan.buffer("colors", count * sizeof(glm::vec4), storage, gpu::Memory::readback);
  plan.pass("sample", program)
      .read(places)
      .read(plan.import(image, std::nullopt, device_sampler.handle()))
      .write(colors)
      .dispatch({count, 1});
  plan.compile();
  auto* given = reinterpret_cast<glm::vec4*>(plan.get(places).mapped());
  for (std::size_t i = 0; i < count; ++i) given[i] = inputs[i].a;
  plan.execute();
  std::vector<glm::vec4> result(count);
  std::memcpy(result.data(), plan.get(colors).mapped(), count * sizeof(glm::vec4));
  return result;
}

std::vector<scene::Sampler> samplers() {
  using scene::Filter;
  constexpr auto repeat = shared::wrap_repeat, clamp = shared::wrap_clamp,
                 mirror = shared::wrap_mirror;
  return {{repeat, clamp, Filter::linear, Filter::linear, true, Filter::linear},
          {mirror, repeat, Filter::linear, Filter::linear, true, Filter::nearest},
          {clamp, mirror, Filter::nearest, Filter::linear, true, Filter::linear},
          {mirror, mirror, Filter::linear, Filter::nearest, true, Filter::nearest},
          {repeat, repeat, Filter::linear, Filter::linear, false, Filter::nearest}};
}

class TextureHeap : public testing::TestWithParam<bool> {};

TEST_P(TextureHeap, MatchesHardwareSampler) {
  scene::Scene scene = *SceneBuilder().build();
  scene.images = {noise(7, 5, false), noise(37, 20, GetParam())};
  for (const scene::Sampler& sampler : samplers()) scene.textures.push_back({1, sampler});
  const FrameRig rig(std::make_shared<const scene::Scene>(scene), look({0, 0, 3}, {0, 0, 0}));
  const ShaderFunctions heap(shaders::sample_texture, &rig);
  RandomInputs random(11);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 4000; ++i) {
    inputs.push_back({.a = {random.uniform(-3.0f, 3.0f), random.uniform(-3.0f, 3.0f),
                            random.uniform(-1.0f, 7.0f), 0.0f}});
  }
  for (std::uint32_t texture = 0; texture < scene.textures.size(); ++texture) {
    const auto expected = sampled(scene.images[1], scene.textures[texture].sampler, inputs);
    const auto got = heap.call(texture, inputs);
    int different = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const float distance = glm::distance(got[i].x, expected[i]);
      sum += distance;
      // Samplers weight texels in steps of 1/256 and select texels and levels with low precision.
      different += distance > 0.02f;
    }
    EXPECT_LE(different, 40) << "sampler " << texture;
    EXPECT_LE(sum / static_cast<double>(inputs.size()), 0.006) << "sampler " << texture;
  }
}

// What lies beyond an image is another one.
TEST(TextureHeapEdges, ReadsNoTexelOutsideTheImage) {
  using scene::Filter;
  scene::Scene scene = *SceneBuilder().build();
  scene.images = {noise(1, 1, false), noise(7, 5, false)};
  const float inside = float(scene.images[0].pixels[0]) / 255.0f;
  for (const auto wrap : {shared::wrap_repeat, shared::wrap_mirror, shared::wrap_clamp}) {
    for (const auto filter : {Filter::nearest, Filter::linear}) {
      scene.textures.push_back({0, {wrap, wrap, filter, filter, true, filter}});
    }
  }
  const FrameRig rig(std::make_shared<const scene::Scene>(scene), look({0, 0, 3}, {0, 0, 0}));
  const ShaderFunctions heap(shaders::sample_texture, &rig);
  std::vector<ShaderInput> inputs;
  for (const float u : {-1e-9f, -0.0f, 0.0f, 0.5f, 0.99999994f, 1.0f, 1.0000001f, -1.0f, 2.0f,
                        -2.0f, 1e9f, -1e9f, 3e38f, -3e38f}) {
    for (const float v : {-1e-9f, 0.25f, 1.0f, 2.0f}) inputs.push_back({.a = {u, v, 0.0f, 0.0f}});
  }
  for (std::uint32_t texture = 0; texture < scene.textures.size(); ++texture) {
    const auto got = heap.call(texture, inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      EXPECT_NEAR(got[i].x.x, inside, 1e-3f) << texture << " at " << inputs[i].a.x;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, TextureHeap, testing::Bool());

TEST(PackTextures, ImagesOfTheSameFileShareTexels) {
  const auto file = std::make_shared<const std::vector<std::uint8_t>>(5, std::uint8_t{7});
  const auto same = std::make_shared<const std::vector<std::uint8_t>>(*file);
  const auto other = std::make_shared<const std::vector<std::uint8_t>>(5, std::uint8_t{8});
  scene::Scene scene;
  for (const auto& [from, srgb] :
       {std::pair(file, false), {same, false}, {other, false}, {file, true}}) {
    scene.images.push_back(noise(8, 8, srgb));
    scene.images.back().file = from;
    scene.textures.push_back({static_cast<std::uint32_t>(scene.images.size() - 1), {}});
  }
  const render::PackedTextures packed = render::pack_textures(scene, 1 << 20);
  const auto& textures = packed.textures;
  EXPECT_EQ(textures[1].first_texel, textures[0].first_texel);
  EXPECT_EQ(packed.texels.size(), 3 * scene.images[0].pixels.size() / 4);
  for (const std::size_t i : {2, 3}) {
    EXPECT_NE(textures[i].first_texel, textures[0].first_texel);
    EXPECT_EQ(std::memcmp(&packed.texels[textures[i].first_texel], scene.images[i].pixels.data(),
                          scene.images[i].pixels.size()),
              0);
  }
}

TEST(PackTextures, DropsTopMipLevelsToFitBudget) {
  scene::Scene scene;
  scene.images = {noise(2048, 8, false), noise(64, 64, false)};
  scene.textures = {{0, {}}, {1, {}}};
  const auto packed = render::pack_textures(scene, 1u << 27);
  ASSERT_EQ(packed.textures.size(), 2u);
  EXPECT_EQ(packed.textures[0].width, 1024u);
  EXPECT_EQ(packed.textures[0].height, 4u);
  EXPECT_EQ(packed.textures[0].levels, scene.images[0].levels - 1);
  EXPECT_EQ(packed.textures[1].width, 64u);
  std::uint32_t first = 0;
  std::memcpy(&first, &scene.images[1].pixels[0], 4);
  EXPECT_EQ(packed.texels[packed.textures[1].first_texel], first);

  const auto small = render::pack_textures(scene, 3000);
  EXPECT_LE(small.texels.size(), 3000u);
  EXPECT_EQ(small.textures[1].width, 32u);
  EXPECT_THROW(render::pack_textures(scene, 1), gpu::GpuError);
}

}  // namespace
}  // namespace heliograph::test
