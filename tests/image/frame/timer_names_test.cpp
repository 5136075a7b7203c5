#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

/// Names of the source files of shaders, and of kernels that have none, without folder and
/// extension.
std::set<std::string> shader_stems() {
  std::set<std::string> stems;
  for (const char* folder : {HELIOGRAPH_SHADERS_FOLDER, HELIOGRAPH_KERNELS_FOLDER}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) stems.insert(entry.path().stem().string());
    }
  }
  return stems;
}

std::vector<std::string> parts_of(const std::string& timer) {
  std::vector<std::string> parts{""};
  for (const char c : timer) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string name;
  for (const std::string& part : parts) name += (name.empty() ? "" : "_") + part;
  return name;
}

/// The shader that a timer's pass runs, by name: "gbuffer.2.hits" is gbuffer_hits. Numbers of
/// rounds and halves of iterations are no part of it. Passes over a ray stream share a shader
/// whatever the stream is called.
std::string shader_of(const std::string& timer, const std::set<std::string>& stems) {
  auto parts = parts_of(timer);
  std::erase_if(parts, [](const std::string& part) {
    return part == "first" || part == "second" ||
           std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
  });
  if (stems.contains(joined(parts))) return joined(parts);
  if (parts.size() < 2) return {};
  const std::string& last = parts.back();
  std::vector<std::string> candidates{"rays_" + last, "specular_" + last, "visibility_" + last,
                                      "rays_" + parts[parts.size() - 2] + "_" + last};
  if (last == "reproject") candidates = {"reproject"};
  if (last == "trace") candidates = {"trace_closest"};
  if (last == "occlusion") candidates = {"trace_any"};
  for (const std::string& candidate : candidates) {
    if (stems.contains(candidate)) return candidate;
  }
  return {};
}

std::vector<protocol::Settings> all_settings() {
  std::vector<protocol::Settings> all(6);
  all[1].specular.half_resolution = all[1].shadow_blur.half_resolution = true;
  all[1].indirect.enabled = true;
  all[2].reference.use = protocol::ReferenceUse::always;
  all[3].reference.use = protocol::ReferenceUse::always;
  all[3].reference.scope = protocol::ReferenceScope::full;
  all[5].reference.use = protocol::ReferenceUse::when_static;
  for (const char* assignment :
       {"gbuffer.source=raster", "reinhard.mode=exact", "exposure.mode=automatic",
        "shadow_temporal.rectification=percentile", "specular_temporal.rectification=percentile",
        "shadow_blur.kernel=separable", "specular_blur.kernel=separable",
        "specular.sort_rays=true"}) {
    EXPECT_TRUE(protocol::set_by_path(all[4], assignment)) << assignment;
  }
  return all;
}

TEST(TimerNames, AreThoseOfShaderFiles) {
  SceneBuilder builder;
  shared::Material glass = surface({0.5f, 0.7f, 0.5f}, 0.1f);
  glass.base_color.w = 0.4f;
  glass.flags = shared::material_alpha_blend;
  scene::MaterialLayers volume;
  volume.transmission = 0.5f;
  volume.thickness = 0.1f;
  builder.place(builder.add_sphere(1.0f, surface(glm::vec3(0.5f))));
  builder.place(builder.add_quad({{{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}}},
                                 builder.with_layers(glass, volume)));
  builder.add_sun({-0.6f, -1, -0.4f}, glm::vec3(2.5f), 1.0f);
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 5}, {0, 0, 0}), 32, 18);
  const std::set<std::string> stems = shader_stems();
  std::set<std::string> timers;
  for (const protocol::Settings& settings : all_settings()) {
    rig.apply(settings);
    for (const auto& work : rig.renderer.work()) timers.insert(work.name);
  }
  EXPECT_GE(timers.size(), 60u);
  for (const std::string& timer : timers) {
    EXPECT_NE(shader_of(timer, stems), "") << "no shader or kernel belongs to the timer " << timer;
  }
}

}  // namespace
}  // namespace heliograph::test
