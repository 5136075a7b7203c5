#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/engine_options.hpp"
#include "protocol/json/suggestions.hpp"
#include "protocol/limits.hpp"
#include "scene/animation/pose.hpp"
#include "scene/camera.hpp"
#include "scene/environment.hpp"
#include "scene/import.hpp"
#include "session/library/environment_source.hpp"
#include "session/rendering/capture_content.hpp"

namespace heliograph::cli {
namespace {

constexpr int warm_up_frames = 3;
constexpr std::uint32_t measured_frames = 16;

scene::Environment choose_environment(const RenderOptions& options) {
  if (!options.environment.empty()) return scene::load_environment(options.environment);
  const auto beside = session::environment_beside(options.scene, options.scene.parent_path());
  return beside ? scene::load_environment(*beside) : scene::constant_environment(glm::vec3(1.0f));
}

scene::Camera choose_camera(const scene::Scene& scene, const RenderOptions& options) {
  std::vector<std::string_view> names;
  for (const scene::Camera& camera : scene.cameras) {
    if (options.camera.empty() || camera.name == options.camera) return camera;
    names.push_back(camera.name);
  }
  if (!options.camera.empty()) {
    throw std::runtime_error("--camera: the scene has no camera " + options.camera +
                             protocol::suggestion(options.camera, names));
  }
  const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
  return scene::fit_camera(scene.bounds, scene::Camera().vertical_fov, aspect);
}

template <class Value>
Value accepted(protocol::Result<Value> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return *std::move(result);
}

void accept(const protocol::Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().message);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Times of many frames, pass by pass in the order of the frame.
class Timings {
 public:
  void add(const render::Frame& frame) {
    frame_ms_.push_back(frame.milliseconds);
    for (const render::PassTime& pass : frame.passes) {
      auto& times = passes_[pass.name];
      if (times.empty()) order_.push_back({pass.name, pass.kind});
      times.push_back(pass.milliseconds);
    }
  }

  nlohmann::json json() const {
    nlohmann::json passes = nlohmann::json::array();
    for (const auto& [name, kind] : order_) {
      passes.push_back(
          {{"name", name}, {"kind", protocol::enum_name(kind)}, {"ms", median(passes_.at(name))}});
    }
    return {{"frames", frame_ms_.size()}, {"frame_ms", median(frame_ms_)}, {"passes", passes}};
  }

 private:
  struct Pass {
    std::string name;
    protocol::PassKind kind;
  };
  std::vector<double> frame_ms_;
  std::vector<Pass> order_;
  std::map<std::string, std::vector<double>> passes_;
};

void choose_reference(protocol::Settings& settings, const std::string& scope) {
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope =
      scope == "full" ? protocol::ReferenceScope::full : protocol::ReferenceScope::same_paths;
}

/// The median times of frames that never converge, as one line of JSON.
void print_timings(render::Engine& engine, render::Renderer& renderer,
                   const protocol::Settings& settings, const RenderOptions& options) {
  protocol::Settings endless = settings;
  endless.accumulation.max_samples = protocol::max_samples_per_pixel;
  accept(renderer.set_settings(endless));
  for (int i = 0; i < warm_up_frames; ++i) renderer.render();
  Timings timings;
  const std::uint32_t frames = options.frames.value_or(measured_frames);
  for (std::uint32_t i = 0; i < frames; ++i) timings.add(renderer.render());
  nlohmann::json line = timings.json();
  line["scene"] = options.scene.filename().string();
  line["device"] = engine.device().name;
  line["tracer"] = protocol::enum_name(engine.tracer());
  line["width"] = options.width;
  line["height"] = options.height;
  std::printf("%s\n", line.dump().c_str());
}

/// The format by the extension of the file.
protocol::ImageFormat format_of(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".jpg") return protocol::ImageFormat::jpeg;
  if (const auto format = protocol::enum_value<protocol::ImageFormat>(
          extension.substr(std::min<std::size_t>(extension.size(), 1)))) {
    return *format;
  }
  throw std::runtime_error("--output: must be a .png, .jpg, .exr or .npy file, not " +
                           file.string());
}

session::CaptureContent render_image(render::Renderer& renderer, const RenderOptions& options,
                                     protocol::ImageFormat format) {
  std::uint32_t samples = 0;
  bool converged = false;
  while (!converged && samples < options.samples.value_or(protocol::max_samples_per_pixel)) {
    const render::Frame frame = renderer.render();
    samples = frame.samples;
    converged = frame.converged;
  }
  return accepted(session::read_content(renderer, options.buffer, format));
}

void write_file(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

/// The camera at a time of the clip, if the clip animates it.
scene::Camera camera_in_clip(const scene::Scene& scene, const scene::Camera& camera,
                             const std::string& clip_name, double seconds) {
  const scene::Clip* const clip = scene::find_clip(scene, clip_name);
  if (!clip || !scene::carries(scene, *clip, camera)) return camera;
  scene::Pose pose = scene::rest_pose(scene);
  scene::evaluate(scene, *clip, seconds, pose);
  return scene::camera_at(scene, camera, pose);
}

/// "run.png" -> "run_0007.png"
std::filesystem::path numbered(const std::filesystem::path& path, std::uint32_t number) {
  std::string digits = std::to_string(number);
  digits.insert(0, 4 - std::min<std::size_t>(digits.size(), 4), '0');
  std::filesystem::path result = path;
  return result.replace_filename(path.stem().string() + "_" + digits + path.extension().string());
}

}  // namespace

int run(const RenderOptions& options) {
  const protocol::ImageFormat format = format_of(options.output);
  protocol::Settings settings = parse_settings(options.settings);
  if (!options.reference.empty()) choose_reference(settings, options.reference);
  if (options.samples) settings.accumulation.max_samples = static_cast<int>(*options.samples);
  auto imported = std::make_unique<scene::Scene>(scene::import_gltf(options.scene, options.limits));
  auto environment = std::make_shared<const scene::Environment>(choose_environment(options));
  const scene::Camera camera = choose_camera(*imported, options);

  render::Engine engine(engine_options(options.device));
  if (const std::string error = engine.shader_error(); !error.empty()) {
    throw std::runtime_error(error);
  }
  render::Renderer renderer(engine);
  const auto resources = engine.upload_and_free_pixels(std::move(imported), std::move(environment));
  const std::shared_ptr<const scene::Scene>& scene = render::scene_of(*resources);
  renderer.set_scene(resources);
  renderer.set_size(options.width, options.height);
  renderer.set_camera(camera);
  accept(renderer.set_settings(settings));
  if (options.timings) {
    print_timings(engine, renderer, settings, options);
    // Start again without history, so that the file does not depend on --timings.
    renderer.set_scene(resources);
    accept(renderer.set_settings(settings));
  }
  renderer.set_frame_seconds(static_cast<float>(1.0 / options.fps));
  const std::uint32_t frames = options.timings ? 1 : options.frames.value_or(1);
  for (std::uint32_t i = 0; i < frames; ++i) {
    const double seconds = options.time + i / options.fps;
    accept(renderer.set_pose(options.clip, seconds));
    renderer.set_camera(camera_in_clip(*scene, camera, options.clip, seconds));
    const session::CaptureContent image = render_image(renderer, options, format);
    write_file(frames == 1 ? options.output : numbered(options.output, i),
               session::encode_content(image, format));
  }
  return 0;
}

}  // namespace heliograph::cli
