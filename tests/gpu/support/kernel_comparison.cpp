#include "tests/gpu/support/kernel_comparison.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <glm/gtc/packing.hpp>

#include "render/resources/gbuffer_formats.hpp"
#include "tests/gpu/support/uniform_gbuffer.hpp"

namespace heliograph::test {

struct RandomFrame::Surfaces {
  std::vector<glm::vec4> normals, motion;
  std::vector<std::uint32_t> base_color, surface, instance;
  std::vector<std::uint64_t> emissive;
  std::vector<glm::vec2> slope;
};

RandomFrame::Surfaces RandomFrame::surfaces(float shift) {
  const VkExtent2D extent = rig_.plan().extent();
  const auto width = static_cast<float>(extent.width), height = static_cast<float>(extent.height);
  Surfaces made;
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      const float at = static_cast<float>(x) + shift;
      const bool left = at < 0.5f * width;
      const bool hole = unit() < 0.05f || (left && y < extent.height / 6);
      const glm::vec3 noise(unit() - 0.5f, unit() - 0.5f, unit() - 0.5f);
      const glm::vec3 face = left ? glm::vec3(0.2f, 0.6f, 0.9f) : glm::vec3(-0.5f, -0.3f, 0.7f);
      const glm::vec3 geometric = glm::normalize(face);
      const glm::vec3 shading = glm::normalize(face + 0.05f * noise);
      const float view_z = hole ? 0.0f : 2.0f + 0.01f * at + (left ? 0.0f : 1.0f);
      made.normals.emplace_back(hole ? glm::vec2(0.0f) : octahedral(shading),
                                hole ? glm::vec2(0.0f) : octahedral(geometric));
      made.base_color.push_back(glm::packUnorm4x8({unit(), unit(), unit(), unit()}));
      const float roughness = left ? 0.5f * unit() : 0.3f + 0.01f * unit();
      made.surface.push_back(
          glm::packUnorm4x8({roughness, unit(), unit() < 0.1f ? 1.0f : 0.0f, 0.0f}));
      made.emissive.push_back(glm::packHalf4x16({2.0f * unit(), unit(), 1e-5f * unit(), 1.0f}));
      const glm::vec2 moved(shift + 0.3f * unit(), 0.4f * (unit() - 0.5f));
      made.motion.emplace_back(hole ? 0.0f : moved.x / width, hole ? 0.0f : moved.y / height,
                               hole ? 0.0f : 0.005f * (unit() - 0.5f), view_z);
      made.slope.emplace_back(0.01f, 0.001f);
      made.instance.push_back(hole ? 0u : (left ? 1u : 2u) + (unit() < 0.05f ? 2u : 0u));
    }
  }
  return made;
}

render::GBuffer RandomFrame::gbuffer() {
  const auto image = [&](const std::string& name, std::size_t signal, const auto& texels) {
    return rig_.input(name, render::gbuffer_formats[signal], texels);
  };
  const Surfaces now = surfaces(1.6f), before = surfaces(0.0f);
  render::GBuffer made;
  made.normals = image("normals", 0, now.normals);
  made.base_color = image("base_color", 1, now.base_color);
  made.surface = image("surface", 2, now.surface);
  made.layers = rig_.plan().image("layers", render::gbuffer_layers_format, 0, VkExtent2D{1, 1});
  made.motion = image("motion", 3, now.motion);
  made.emissive = image("emissive", 4, now.emissive);
  made.depth_slope = image("slope", 5, now.slope);
  made.instance = image("instance", 6, now.instance);
  made.previous_normals = image("before.normals", 0, before.normals);
  made.previous_surface = image("before.surface", 2, before.surface);
  made.previous_motion = image("before.motion", 3, before.motion);
  made.previous_instance = image("before.instance", 6, before.instance);
  return made;
}

gpu::ImageRef RandomFrame::four(const std::string& name, const glm::vec4& low,
                                const glm::vec4& high) {
  const VkExtent2D extent = rig_.plan().extent();
  std::vector<glm::vec4> texels(std::size_t{extent.width} * extent.height);
  for (glm::vec4& texel : texels) {
    texel = glm::mix(low, high, glm::vec4(unit(), unit(), unit(), unit()));
  }
  return rig_.input(name, VK_FORMAT_R32G32B32A32_SFLOAT, texels);
}

gpu::ImageRef RandomFrame::two(const std::string& name, float low, float high) {
  const VkExtent2D extent = rig_.plan().extent();
  std::vector<glm::vec2> texels(std::size_t{extent.width} * extent.height);
  for (glm::vec2& texel : texels) {
    texel = glm::mix(glm::vec2(low), glm::vec2(high), glm::vec2(unit(), unit()));
  }
  return rig_.input(name, VK_FORMAT_R32G32_SFLOAT, texels);
}

gpu::ImageRef RandomFrame::bits(const std::string& name) {
  const VkExtent2D extent = rig_.plan().extent();
  std::vector<float> texels(std::size_t{extent.width} * extent.height);
  for (float& texel : texels) texel = unit() < 0.4f ? 0.0f : 1.0f;
  return rig_.input(name, VK_FORMAT_R32_SFLOAT, texels);
}

const render::FrameInputs& with_host_kernels(FrameRig& rig, bool host) {
  rig.plan().use_host_kernels(host);
  return rig.inputs();
}

render::FrameInputs with_tracer(const render::FrameInputs& in, const tracing::RayTracer& tracer) {
  return {in.programs,        in.scene,       in.tables,         tracer,
          in.structure,       in.constants,   in.half_constants, in.settings,
          in.clock,           in.moving,      in.scene_motion,   in.all_buffers,
          in.split_sum_table, in.sheen_table, in.ltc_table,      in.shown};
}

ErrorStatistics compare(const render::FloatImage& expected, const render::FloatImage& actual) {
  ErrorStatistics result{};
  for (std::size_t i = 0; i < expected.rgba.size(); ++i) {
    const double value = expected.rgba[i];
    double off = std::abs(value - actual.rgba[i]) / (1.0 + std::abs(value));
    if (!std::isfinite(off)) off = 1e9;
    result.mean += off;
    result.max = std::max(result.max, off);
    result.outliers += off > 0.01 ? 1.0 : 0.0;
    result.magnitude += std::abs(value);
  }
  const auto count = static_cast<double>(expected.rgba.size());
  return {result.mean / count, result.max, result.outliers / count, result.magnitude / count};
}

void expect_same_gbuffer(const FrameRig& rig, const render::GBuffer& expected,
                         const render::GBuffer& actual, const std::string& which) {
  using render::GBuffer;
  const std::pair<const char*, gpu::ImageRef GBuffer::*> images[] = {
      {"normals", &GBuffer::normals},   {"base color", &GBuffer::base_color},
      {"surface", &GBuffer::surface},   {"motion", &GBuffer::motion},
      {"emissive", &GBuffer::emissive}, {"depth slope", &GBuffer::depth_slope},
      {"instance", &GBuffer::instance}};
  for (const auto& [name, image] : images) {
    const ErrorStatistics error = compare(rig.read(expected.*image), rig.read(actual.*image));
    const std::string what = which + ": " + name;
    EXPECT_LT(error.mean, 4e-4) << what;
    EXPECT_LT(error.outliers, 2e-3) << what;
  }
}

void expect_faster(FrameRig& rig, const std::set<std::string>& passes, double least) {
  using Clock = std::chrono::steady_clock;
  rig.run();
  double shader = 1e9, host = 1e9;
  for (int i = 0; i < 8; ++i) {
    const auto start = Clock::now();
    rig.run();
    double rest = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    double kernels = 0.0;
    for (const auto& timing : rig.plan().timings()) {
      if (!timing.host || timing.milliseconds < 0.0f) continue;
      rest -= timing.milliseconds;
      kernels += passes.contains(timing.name) ? timing.milliseconds : 0.0f;
    }
    shader = std::min(shader, rest);
    host = std::min(host, kernels);
  }
  std::string names;
  for (const std::string& name : passes) names += name + " ";
  std::printf("%s: shaders %.2f ms, host %.2f ms, ratio %.1f\n", names.c_str(), shader, host,
              shader / host);
  EXPECT_GT(host, 0.0) << "no host kernel ran";
  EXPECT_GT(shader, least * host) << names;
}

bool has_host_kernels() {
  return device().is_cpu();
}

}  // namespace heliograph::test
