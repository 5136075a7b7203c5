#include "render/resources/environment/environment_prefilter.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "gpu/frame_plan/frame_plan.hpp"
#include "render/resources/environment/environment_table.hpp"
#include "render/resources/environment/irradiance.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

constexpr std::uint32_t largest_cube = 256;
constexpr std::uint32_t smallest_cube = 16;
constexpr std::uint32_t smallest_level = 8;
constexpr std::uint32_t most_samples = 512;  // a texel
constexpr std::uint32_t table_size = 128;
constexpr std::uint32_t sheen_size = 32;

struct PrefilterConstants {
  float roughness;
  float source_size;
  std::uint32_t samples;
};

/// A face spans a quarter of the map's width: no more texels than there is detail.
std::uint32_t cube_size_for(const scene::Environment& environment) {
  return std::bit_floor(std::clamp(environment.width / 4, smallest_cube, largest_cube));
}

/// Narrow lobes need fewer: each sample reads the level that its part of the lobe covers (Krivanek
/// and Colbert, GPU Gems 3, chapter 20, are content with 40), and their levels have most texels.
std::uint32_t samples_for(std::uint32_t level) {
  return level == 0 ? 1 : std::min(256u << (level - 1), most_samples);
}

gpu::Image make_cube(const gpu::Device& device, const char* name, std::uint32_t cube_size) {
  gpu::ImageDesc desc{.name = name, .extent = {cube_size, cube_size}};
  desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  desc.levels = static_cast<std::uint32_t>(std::countr_zero(cube_size / smallest_level)) + 1;
  desc.layers = 6;
  desc.cube = true;
  return gpu::Image(device, desc);
}

gpu::Buffer upload_cells(const gpu::Device& device, const scene::Environment& environment) {
  const std::vector<EnvironmentCell> cells = make_environment_table(environment);
  gpu::Buffer buffer =
      gpu::upload_buffer(device, "environment cells", std::as_bytes(std::span(cells)),
                         VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  // Made now: several renderers on several threads share an environment.
  buffer.texel_view(VK_FORMAT_R32G32B32A32_UINT);
  return buffer;
}

}  // namespace

gpu::Image upload_environment(const gpu::Device& device, const scene::Environment& environment) {
  std::vector<glm::vec4> texels;
  texels.reserve(environment.radiance.size());
  for (const glm::vec3& radiance : environment.radiance) texels.emplace_back(radiance, 1.0f);
  gpu::ImageDesc desc{.name = "environment", .extent = {environment.width, environment.height}};
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  gpu::Image image(device, desc);
  image.upload(std::as_bytes(std::span(texels)));
  return image;
}

gpu::Sampler make_environment_sampler(const gpu::Device& device, bool wrap_u) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.addressModeU =
      wrap_u ? VK_SAMPLER_ADDRESS_MODE_REPEAT : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.maxLod = VK_LOD_CLAMP_NONE;
  return gpu::Sampler(device, info);
}

EnvironmentMaps prefilter_environment(const gpu::Device& device, const Programs& programs,
                                      const scene::Environment& environment) {
  const std::uint32_t cube_size = cube_size_for(environment);
  EnvironmentMaps maps{upload_environment(device, environment),
                       make_cube(device, "prefiltered", cube_size),
                       upload_cells(device, environment), project_irradiance(environment)};
  const gpu::Image source_cube = make_cube(device, "environment cube", cube_size);
  const std::uint32_t cube_levels = source_cube.desc().levels;
  const gpu::Sampler around = make_environment_sampler(device, true);
  const gpu::Sampler clamped = make_environment_sampler(device, false);

  gpu::FramePlan plan(device, {cube_size, cube_size});
  const auto map = plan.import(maps.map, std::nullopt, around.handle());
  std::vector<gpu::ImageRef> source_levels;
  for (std::uint32_t level = 0; level < cube_levels; ++level) {
    source_levels.push_back(plan.import(source_cube, level, VK_NULL_HANDLE));
  }
  plan.pass("environment.cube", programs.compute(shaders::environment_cube))
      .read(map)
      .write(source_levels[0])
      .dispatch(gpu::each_pixel(), 6);
  for (std::uint32_t level = 1; level < cube_levels; ++level) {
    plan.pass("environment.mip", programs.compute(shaders::environment_mip))
        .read(source_levels[level - 1])
        .write(source_levels[level])
        .dispatch({cube_size >> level, cube_size >> level}, 6);
  }
  plan.compile();
  plan.execute();

  // A plan of its own: the cube as a whole is another resource than its levels, and the wait
  // between two plans is what orders them.
  gpu::FramePlan filter(device, {cube_size, cube_size});
  const auto filter_source = filter.import(source_cube, std::nullopt, clamped.handle());
  for (std::uint32_t level = 0; level < cube_levels; ++level) {
    const float roughness = static_cast<float>(level) / (cube_levels - 1);
    const auto target = filter.import(maps.prefiltered, level, VK_NULL_HANDLE);
    filter.pass("environment.prefilter", programs.compute(shaders::environment_prefilter))
        .read(filter_source)
        .write(target)
        .constants(PrefilterConstants{roughness, static_cast<float>(cube_size), samples_for(level)})
        .dispatch({cube_size >> level, cube_size >> level}, 6);
  }
  filter.compile();
  filter.execute();
  if (device.is_cpu()) {
    maps.host = std::make_shared<const kernels::Environment>(
        kernels::copy_environment(environment, maps.prefiltered));
  }
  return maps;
}

gpu::Image make_sheen_table(const gpu::Device& device, const Programs& programs) {
  gpu::ImageDesc desc{.name = "sheen albedo", .extent = {sheen_size, sheen_size}};
  desc.format = VK_FORMAT_R32_SFLOAT;
  desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  desc.mapped = device.is_cpu();  // host kernels read it
  gpu::Image table(device, desc);
  gpu::FramePlan plan(device, desc.extent);
  plan.pass("sheen_table", programs.compute(shaders::sheen_table))
      .write(plan.import(table, 0, VK_NULL_HANDLE))
      .dispatch(desc.extent);
  plan.compile();
  plan.execute();
  return table;
}

gpu::Image make_split_sum_table(const gpu::Device& device, const Programs& programs) {
  gpu::ImageDesc desc{.name = "split sum", .extent = {table_size, table_size}};
  desc.format = VK_FORMAT_R32G32_SFLOAT;
  desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  desc.mapped = device.is_cpu();  // host kernels read it
  gpu::Image table(device, desc);
  gpu::FramePlan plan(device, desc.extent);
  plan.pass("split_sum_table", programs.compute(shaders::split_sum_table))
      .write(plan.import(table, 0, VK_NULL_HANDLE))
      .constants(std::uint32_t{1024})
      .dispatch(desc.extent);
  plan.compile();
  plan.execute();
  return table;
}

}  // namespace heliograph::render
