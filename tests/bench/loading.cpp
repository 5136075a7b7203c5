// From a scene file to its first frame, stage by stage: one line of JSON per load. The first load
// includes the creation of pipelines. "processor_seconds" is CPU time of all threads, which is
// robust on a busy machine. Memory peaks are relative to the start; "decoded_bytes" are geometry,
// images and mip levels, once each; "kept" is what is resident once the temporary memory of loading
// has been given back. With --two-steps the scene is shown without its textures first, as viewers
// of the server see it: "file_to_untextured_frame" is the time up to that frame. With --cancel,
// loads are cancelled so many seconds after their start, and "late" is how long they go on.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <thread>
#include <utility>

#include "render/api/kept_textures.hpp"
#include "render/api/renderer.hpp"
#include "scene/camera/camera.hpp"
#include "scene/gltf/geometry/tangents.hpp"
#include "scene/import.hpp"

namespace heliograph::bench {
namespace {

struct Options {
  std::vector<std::filesystem::path> scenes;
  std::string environment;
  std::string device;
  int repeats = 3;
  std::vector<double> cancel;
  bool two_steps = false;
  double most_peak = 0.0;
  double most_late = 0.0;
  std::uint32_t width = 640;
  std::uint32_t height = 360;
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A line of /proc/self/status, bytes.
std::uint64_t status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == key && status >> kibibytes) return kibibytes << 10;
  }
  return 0;
}

/// Peak resident memory since restart_peak().
std::uint64_t peak_bytes() {
  return status_bytes("VmHWM:");
}

/// Resets the peak and returns the current resident memory.
std::uint64_t restart_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;
  return status_bytes("VmRSS:");
}

/// Time of one thread to generate tangents of all meshes; part of "geometry", where it is parallel.
double time_tangents(const scene::Scene& scene) {
  const Clock::time_point start = Clock::now();
  for (const scene::Mesh& mesh : scene.meshes) {
    const shared::TextureSlot& map = scene.materials[mesh.material].normal_texture;
    if (map.texture == shared::no_texture) continue;
    std::vector<shared::Vertex> vertices = mesh.vertices;
    std::vector<std::uint32_t> indices = mesh.indices;
    scene::generate_tangents(vertices, indices, map);
  }
  return seconds_since(start);
}

/// Seconds between the first report of a stage and that of the next.
class StageTimes {
 public:
  void enter(std::string_view stage) {
    if (stage == stage_) return;
    leave();
    stage_ = stage;
    since_ = Clock::now();
  }
  void leave() {
    if (!stage_.empty()) seconds_[stage_] += seconds_since(since_);
    stage_.clear();
  }
  const std::map<std::string, double>& seconds() const { return seconds_; }

 private:
  std::string stage_;
  Clock::time_point since_;
  std::map<std::string, double> seconds_;
};

void render_frame(render::Engine& engine,
                  const std::shared_ptr<const render::SceneResources>& resources,
                  const Options& options) {
  const scene::Scene& scene = *render::scene_of(*resources);
  render::Renderer renderer(engine);
  renderer.set_scene(resources);
  renderer.set_size(options.width, options.height);
  const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
  renderer.set_camera(scene.cameras.empty()
                          ? scene::fit_camera(scene.bounds, scene::Camera().vertical_fov, aspect)
                          : scene.cameras.front());
  renderer.render();
}

nlohmann::json load(render::Engine& engine, const std::filesystem::path& path,
                    const std::shared_ptr<const scene::Environment>& environment,
                    const Options& options) {
  const std::uint64_t before = restart_peak();
  const Clock::time_point start = Clock::now();
  const std::clock_t spent_before = std::clock();
  scene::ImportTimes times;
  scene::ImportOptions import_options{.times = &times,
                                      .kept_textures = render::kept_textures(engine)};
  std::shared_ptr<const render::SceneResources> first;
  double untextured_frame = 0.0;
  if (options.two_steps) {
    import_options.untextured = [&](std::unique_ptr<scene::Scene> scene, std::uint64_t) {
      first = engine.upload(std::shared_ptr<const scene::Scene>(std::move(scene)), environment);
      render_frame(engine, first, options);
      untextured_frame = seconds_since(start);
    };
  }
  auto whole = std::make_unique<scene::Scene>(scene::import_gltf(path, {}, import_options));
  const Clock::time_point imported = Clock::now();
  const std::uint64_t decoded = whole->bytes();
  const std::uint64_t import_peak = peak_bytes() - before;
  StageTimes stages;
  const auto resources = engine.upload_and_free_pixels(
      std::move(whole), environment, [&](std::string_view stage, float) { stages.enter(stage); },
      std::exchange(first, nullptr));
  stages.leave();
  const std::shared_ptr<const scene::Scene>& scene = render::scene_of(*resources);
  const double upload = seconds_since(imported);
  const Clock::time_point uploaded = Clock::now();
  const std::uint64_t loading_peak = peak_bytes() - before;
  const std::uint64_t kept = restart_peak() - before;
  render_frame(engine, resources, options);
  const double frame = seconds_since(uploaded);
  const double total = seconds_since(start);
  const auto spent = static_cast<double>(std::clock() - spent_before) / CLOCKS_PER_SEC;
  return {{"scene", path.stem().string()},
          {"triangles", scene->triangle_count()},
          {"images", scene->images.size()},
          {"parse", times.parse},
          {"check", times.check},
          {"geometry", times.geometry},
          {"images_decoded", times.images},
          {"place", times.place},
          {"import", times.total},
          {"upload_stages", stages.seconds()},
          {"upload_and_bvh", upload},
          {"first_frame", frame},
          {"file_to_untextured_frame", untextured_frame},
          {"file_to_first_frame", total},
          {"processor_seconds", spent},
          {"tangents_of_one_thread", time_tangents(*scene)},
          {"decoded_bytes", decoded},
          {"import_peak_bytes", import_peak},
          {"loading_peak_bytes", loading_peak},
          {"loading_peak_of_decoded", double(loading_peak) / double(decoded)},
          {"kept_bytes", scene->bytes() + render::memory_bytes(*resources)},
          {"kept_resident_bytes", kept},
          {"loading_peak_of_kept", double(loading_peak) / double(kept)},
          {"program_bytes_before", before},
          {"program_bytes_after", status_bytes("VmRSS:")}};
}

/// A load that is cancelled `seconds` after its start.
nlohmann::json cancel(render::Engine& engine, const std::filesystem::path& path,
                      const std::shared_ptr<const scene::Environment>& environment,
                      double seconds) {
  std::stop_source stop;
  const Clock::time_point start = Clock::now();
  const auto check = [&](std::string_view, float) { scene::throw_if_cancelled(stop.get_token()); };
  std::jthread canceller([&](const std::stop_token& end) {
    while (!end.stop_requested() && seconds_since(start) < seconds) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    stop.request_stop();
  });
  nlohmann::json result{{"scene", path.stem().string()}, {"cancelled_after", seconds}};
  try {
    auto scene = std::make_unique<scene::Scene>(
        scene::import_gltf(path, {},
                           {.progress = check,
                            .stop = stop.get_token(),
                            .kept_textures = render::kept_textures(engine)}));
    engine.upload_and_free_pixels(std::move(scene), environment, check);
    result["complete_after"] = seconds_since(start);
  } catch (const scene::LoadCancelled&) {
    result["late"] = seconds_since(start) - seconds;
  }
  return result;
}

void print(const nlohmann::json& line) {
  std::printf("%s\n", line.dump().c_str());
  std::fflush(stdout);
}

void check(const nlohmann::json& line, const char* name, double most) {
  if (most <= 0.0 || line.value(name, 0.0) <= most) return;
  throw std::runtime_error(line["scene"].get<std::string>() + ": " + name + " is " +
                           line[name].dump() + ", the limit is " + std::to_string(most));
}

void run(const Options& options) {
  render::Engine engine({.device = options.device});
  const auto environment = std::make_shared<const scene::Environment>(
      options.environment.empty() ? scene::constant_environment(glm::vec3(1.0f))
                                  : scene::load_environment(options.environment));
  for (const std::filesystem::path& path : options.scenes) {
    for (int i = 0; i < options.repeats; ++i) {
      const nlohmann::json line = load(engine, path, environment, options);
      print(line);
      check(line, "loading_peak_of_kept", options.most_peak);
    }
    for (const double seconds : options.cancel) {
      const nlohmann::json line = cancel(engine, path, environment, seconds);
      print(line);
      check(line, "late", options.most_late);
    }
  }
}

}  // namespace
}  // namespace heliograph::bench

int main(int count, char** arguments) {
  heliograph::bench::Options options;
  CLI::App app("Times from a scene file to its first frame, seconds.");
  app.add_option("scenes", options.scenes, "glTF files")->required();
  app.add_option("--environment", options.environment, ".hdr or .exr file");
  app.add_option("--device", options.device, "Part of the name of the Vulkan device to use");
  app.add_option("--repeats", options.repeats, "Number of loads of each scene");
  app.add_option("--width", options.width, "Frame width, pixels");
  app.add_option("--height", options.height, "Frame height, pixels");
  app.add_flag("--two-steps", options.two_steps,
               "Render the scene without its textures before these are decoded");
  app.add_option("--cancel", options.cancel, "Cancel loads after so many seconds, one each");
  app.add_option("--most-peak", options.most_peak,
                 "Fail where the peak is more times what stays in memory");
  app.add_option("--most-late", options.most_late,
                 "Fail where a cancelled load goes on for more seconds");
  CLI11_PARSE(app, count, arguments);
  try {
    heliograph::bench::run(options);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph-bench-loading: %s\n", failure.what());
    return 1;
  }
  return 0;
}
