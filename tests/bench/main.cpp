// Times every pass of a frame, relative to the limits of the machine.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <stdexcept>

#include "gpu/frame_plan/frame_size.hpp"
#include "protocol/settings/presets.hpp"
#include "protocol/settings/settings.hpp"
#include "protocol/settings/settings_json.hpp"
#include "render/api/renderer.hpp"
#include "render/frame/engine_parts.hpp"
#include "scene/camera/camera.hpp"
#include "scene/import.hpp"
#include "tests/bench/atrous_rate.hpp"
#include "tests/bench/embree_rate.hpp"
#include "tests/bench/table.hpp"

namespace heliograph::bench {
namespace {

struct Options {
  std::vector<std::filesystem::path> scenes;
  std::vector<std::string> sizes{"640x360"};
  std::vector<std::string> settings;
  std::string preset;
  std::filesystem::path environment;
  std::filesystem::path output;
  std::string device;
  std::string tracer = "auto";
  int frames = 16;
  int warm_up = 24;  // until histories are long and most pixels leave samples out
  float draw_scale = 1.0f;
  int jpeg = 0;  // quality; 0: frames come as pixels
  bool still = false;
  bool overlap = false;
  bool shaders = false;
};

VkExtent2D parse_size(const std::string& text) {
  VkExtent2D extent{};
  char end = 0;
  if (std::sscanf(text.c_str(), "%ux%u%c", &extent.width, &extent.height, &end) != 2 ||
      extent.width == 0 || extent.height == 0) {
    throw std::runtime_error("--size " + text + " must look like 640x360");
  }
  return extent;
}

protocol::Settings parse_settings(const Options& options) {
  protocol::Settings settings;
  // Measured frames never converge.
  settings.accumulation.max_samples = 65536;
  if (!options.preset.empty()) {
    const auto preset = protocol::find_preset(options.preset);
    if (!preset) throw std::runtime_error(preset.error().message);
    const auto applied = protocol::apply_patch(settings, preset->settings.value());
    if (!applied) throw std::runtime_error(applied.error().message);
  }
  for (const std::string& assignment : options.settings) {
    const auto applied = protocol::set_by_path(settings, assignment);
    if (!applied) throw std::runtime_error(applied.error().message);
  }
  return settings;
}

/// A floor and a wall in one mesh: the default scene.
scene::Scene plain_scene() {
  scene::Scene scene;
  scene.name = "two quads";
  scene.material_names.emplace_back("plain");
  shared::Material material{};
  material.base_color = glm::vec4(0.8f);
  material.roughness = 0.3f;
  material.normal_scale = 1.0f;
  material.ior = 1.5f;
  for (auto* slot :
       {&material.base_color_texture, &material.metallic_roughness_texture,
        &material.normal_texture, &material.occlusion_texture, &material.emissive_texture}) {
    slot->texture = shared::no_texture;
  }
  scene.materials.push_back(material);
  scene::Mesh mesh;
  const auto quad = [&](glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const glm::vec3 normal = glm::normalize(glm::cross(u, v));
    for (const glm::vec3& point : {corner, corner + u, corner + u + v, corner + v}) {
      shared::Vertex vertex{};
      vertex.position = point;
      vertex.normal = normal;
      vertex.color_rg = vertex.color_ba = 0xffffffffu;
      vertex.tangent = glm::vec4(glm::normalize(u), 1.0f);
      mesh.vertices.push_back(vertex);
      mesh.bounds.include(point);
    }
    for (const std::uint32_t index : {0u, 1u, 2u, 0u, 2u, 3u})
      mesh.indices.push_back(first + index);
  };
  quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
  quad({-4, 0, -4}, {8, 0, 0}, {0, 4, 0});
  scene.bounds = mesh.bounds;
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.emplace_back();
  scene.instances.push_back({0, 0});
  return scene;
}

scene::Camera first_camera(const scene::Scene& scene, VkExtent2D extent) {
  if (!scene.cameras.empty()) return scene.cameras.front();
  const float aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
  return scene::fit_camera(scene.bounds, scene::Camera().vertical_fov, aspect);
}

/// A small orbit around the target, so that consecutive frames differ.
scene::Camera swung(const scene::Camera& camera, int frame) {
  const float angle = glm::radians(0.25f) * std::sin(0.3f * static_cast<float>(frame));
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), angle, camera.up);
  scene::Camera moved = camera;
  moved.eye = camera.target + glm::vec3(turn * glm::vec4(camera.eye - camera.target, 0.0f));
  return moved;
}

/// A renderer with its timings.
struct Run {
  Run(render::Engine& engine, const std::shared_ptr<const render::SceneResources>& resources,
      VkExtent2D extent, const protocol::Settings& settings)
      : renderer(engine) {
    renderer.set_scene(resources);
    renderer.set_size(extent.width, extent.height);
    renderer.keep_buffers(false);  // as sessions do
    const auto accepted = renderer.set_settings(settings);
    if (!accepted) throw std::runtime_error(accepted.error().message);
  }

  /// Begins a frame, before the one that has begun is finished where that can be, and finishes
  /// that. Frames take the time between their ends.
  std::optional<render::Frame> next_overlapping() {
    std::optional<render::Frame> frame;
    if (begun && !renderer.can_begin_another()) frame = finish();
    renderer.begin({});
    if (begun && !frame) return finish();
    begun = true;
    return frame;
  }
  void finish_all() {
    if (std::exchange(begun, false)) renderer.finish();
  }

  render::Renderer renderer;
  Table table;
  bool begun = false;

 private:
  render::Frame finish() {
    render::Frame frame = renderer.finish();
    const auto end = std::chrono::steady_clock::now();
    frame.milliseconds =
        std::chrono::duration<float, std::milli>(end - std::exchange(finished_at_, end)).count();
    return frame;
  }

  std::chrono::steady_clock::time_point finished_at_;
};

/// The bare loop for an iteration of the blur in two halves, such as "visibility.atrous.3", or
/// "visibility.half.atrous.1" of images of half the size.
std::optional<double> bare_loop_milliseconds(const std::string& pass, VkExtent2D extent) {
  static const std::regex iteration(R"((visibility|specular)(\.half)?\.atrous\.(\d))");
  std::smatch parts;
  if (!std::regex_match(pass, parts, iteration)) return std::nullopt;
  const gpu::FrameSize size = gpu::FrameSize::squares(parts[2].matched ? 2 : 1);
  const VkExtent2D texels = size.of(extent);
  return 2.0 * atrous_milliseconds(parts[1] == "visibility", texels.width, texels.height,
                                   1 << std::stoi(parts[3]));
}

/// Adds reference times per pass: Embree alone, in its fastest configuration, on the rays of the
/// last frame, a bare loop for the blur's host kernels, and for host kernels the factor by which
/// the shader is slower.
void add_bounds(nlohmann::json& summary, const RecordingTracer& tracer, const scene::Scene& scene,
                VkExtent2D extent, const std::optional<Run>& shaders) {
  const EmbreeAlone embree(scene);
  bool has_kernels = false, has_shaders = false;
  for (auto& pass : summary.at("passes")) {
    const auto name = pass.at("name").get<std::string>();
    const double ms = pass.at("ms").get<double>();
    const bool host = pass.at("kind") == protocol::enum_name(protocol::PassKind::host);
    if (const auto bare = host ? bare_loop_milliseconds(name, extent) : std::nullopt) {
      pass["bare_loop_ms"] = *bare;
      pass["times_bare_loop"] = ms / *bare;
    }
    if (const auto* stream = tracer.find(name)) {
      const auto alone = embree.fastest(*stream);
      if (alone && alone->milliseconds > 0.01) {
        pass["embree_ms"] = alone->milliseconds;
        pass["embree_way"] = alone->way;
        pass["times_embree"] = ms / alone->milliseconds;
      }
    } else if (shaders && host) {
      has_kernels = true;
      if (const auto shader = shaders->table.median_of_shader(name)) {
        pass["shader_ms"] = *shader;
        pass["shader_times"] = *shader / ms;
        has_shaders = true;
      }
    }
  }
  if (has_kernels && !has_shaders) throw std::runtime_error("--shaders: no shader was timed");
}

nlohmann::json measure(render::Engine& engine, RecordingTracer& tracer, const scene::Scene& scene,
                       const std::shared_ptr<const render::SceneResources>& resources,
                       VkExtent2D extent, const Options& options) {
  const protocol::Settings settings = parse_settings(options);
  std::optional<Run> shaders;
  if (options.shaders) shaders.emplace(engine, resources, extent, settings);
  Run run(engine, resources, extent, settings);
  for (Run* each : {&run, shaders ? &*shaders : nullptr}) {
    if (each) each->renderer.set_draw_scale(options.draw_scale);
  }
  if (options.jpeg > 0) run.renderer.request_jpeg(render::JpegRequest{options.jpeg});
  const scene::Camera camera = first_camera(scene, extent);
  for (int i = 0; i < options.warm_up + options.frames; ++i) {
    for (Run* each : {&run, shaders ? &*shaders : nullptr}) {
      if (!each) continue;
      engine.parts().host_kernels = each == &run;  // read when a renderer makes its passes
      each->renderer.set_camera(options.still ? camera : swung(camera, i));
      const auto frame = options.overlap ? each->next_overlapping() : each->renderer.render();
      if (i >= options.warm_up && frame) each->table.add(*frame);
    }
  }
  engine.parts().host_kernels = true;
  run.finish_all();
  tracer.set_recording(true);
  run.renderer.set_camera(options.still ? camera : swung(camera, options.warm_up + options.frames));
  run.renderer.render();
  tracer.set_recording(false);
  const CopyRates rates = measure_copy_rates(engine.parts().device, extent);
  nlohmann::json summary = run.table.summary(run.renderer.work(), rates);
  add_bounds(summary, tracer, scene, extent, shaders);
  summary["scene"] = scene.name;
  summary["triangles"] = scene.triangle_count();
  summary["device"] = engine.device().name;
  summary["driver"] = engine.device().driver;
  summary["tracer"] = protocol::enum_name(engine.tracer());
  summary["copy_gigabytes_per_second"] = {{"shader", rates.shader * 1e-9},
                                          {"processor", rates.processor * 1e-9}};
  return summary;
}

void run(const Options& options) {
  render::Engine engine(
      {.device = options.device,
       .tracer = options.tracer,
       .jpeg = options.jpeg > 0 ? render::JpegEncoding::on : render::JpegEncoding::off});
  auto recording = std::make_unique<RecordingTracer>(std::move(engine.parts().tracer));
  RecordingTracer& tracer = *recording;
  engine.parts().tracer = std::move(recording);
  const scene::Environment environment = options.environment.empty()
                                             ? scene::constant_environment(glm::vec3(1.0f))
                                             : scene::load_environment(options.environment);
  nlohmann::json results = nlohmann::json::array();
  const auto measure_scene = [&](scene::Scene loaded) {
    const auto scene = std::make_shared<const scene::Scene>(std::move(loaded));
    const auto resources = engine.upload(scene, environment);
    for (const std::string& size : options.sizes) {
      const auto summary = measure(engine, tracer, *scene, resources, parse_size(size), options);
      std::printf("\n%s, %s, %s, %s\n", scene->name.c_str(), size.c_str(),
                  engine.device().name.c_str(),
                  std::string(protocol::enum_name(engine.tracer())).c_str());
      print(summary);
      std::fflush(stdout);
      results.push_back(summary);
    }
  };
  if (options.scenes.empty()) measure_scene(plain_scene());
  for (const auto& path : options.scenes) {
    scene::Scene loaded = scene::import_gltf(path);
    loaded.name = path.stem().string();
    measure_scene(std::move(loaded));
  }
  if (options.output.empty()) return;
  std::ofstream file(options.output);
  file << results.dump(2) << '\n';
  if (!file) throw std::runtime_error("cannot write " + options.output.string());
}

}  // namespace
}  // namespace heliograph::bench

int main(int argc, char** argv) {
  using namespace heliograph::bench;
  Options options;
  CLI::App app(
      "Times every pass of a frame while the camera moves a little: median ms, ns per "
      "pixel, rays per second, bytes of images, time relative to a copy of as "
      "many bytes, to the fastest configuration of Embree alone on the same rays and to a bare "
      "loop "
      "of the blur, and for host kernels the factor by which the shader is slower.");
  app.add_option("scenes", options.scenes, "glTF files; without any, two quads");
  app.add_option("--size", options.sizes, "frame sizes, such as 640x360")->expected(1, -1);
  app.add_option("--frames", options.frames, "measured frames")->check(CLI::PositiveNumber);
  app.add_option("--warm-up", options.warm_up, "frames before them")->check(CLI::NonNegativeNumber);
  app.add_option("--draw-scale", options.draw_scale,
                 "fraction of width and height that frames are drawn at and reconstructed from")
      ->check(CLI::Range(0.1f, 1.0f));
  app.add_option("--jpeg", options.jpeg,
                 "the device encodes every frame at this quality, in place of copying its pixels")
      ->check(CLI::Range(1, 100));
  app.add_option("--set", options.settings, "path=value, as `heliograph render` takes it");
  app.add_option("--preset", options.preset, "a preset, as `heliograph render` takes it");
  app.add_option("--environment", options.environment, "the sky; otherwise white");
  app.add_option("--device", options.device, "part of the device's name");
  app.add_option("--tracer", options.tracer, "as `heliograph serve` takes it");
  app.add_option("--output", options.output, "also write the results to this file, as JSON");
  app.add_flag("--shaders", options.shaders, "also render every frame without host kernels");
  app.add_flag("--still", options.still, "static camera");
  app.add_flag("--overlap", options.overlap,
               "a GPU has the next frame before it is done with the one before, as when streaming");
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heliograph-bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
