#include "cli/render_scene.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/engine_options.hpp"
#include "cli/render_plan.hpp"
#include "cli/render_timings.hpp"
#include "protocol/limits.hpp"
#include "render/api/renderer.hpp"
#include "scene/import.hpp"
#include "scene/studio.hpp"
#include "session/library/environment_source.hpp"
#include "session/rendering/capture_content.hpp"

namespace heliograph::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t measured_frames = 16;

template <class Value>
Value accepted(protocol::Result<Value> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return *std::move(result);
}

void accept(const protocol::Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().message);
}

std::shared_ptr<const scene::Environment> environment_of(const RenderJob& job,
                                                         const fs::path& file) {
  if (job.environment) return job.environment;
  const auto beside = session::environment_beside(file, file.parent_path());
  return std::make_shared<const scene::Environment>(beside ? scene::load_environment(*beside)
                                                           : scene::studio_environment());
}

/// Whether the file can be written; a file that does not exist does not exist afterwards either.
bool is_writable(const fs::path& file) {
  std::error_code ignored;
  const bool existed = fs::exists(file, ignored);
  if (existed && !fs::is_regular_file(file, ignored)) return !fs::is_directory(file, ignored);
  const bool opened = std::ofstream(file, std::ios::app).is_open();
  if (opened && !existed) fs::remove(file, ignored);
  return opened;
}

/// The files of the shots; empty paths for standard output.
std::vector<fs::path> choose_files(RenderJob& job, const fs::path& scene,
                                   const std::vector<Shot>& shots) {
  std::vector<fs::path> files;
  for (const Shot& shot : shots) {
    if (job.output.is_standard_output()) {
      files.emplace_back();
      continue;
    }
    fs::path file = job.output.file(
        {.scene = scene.stem().string(), .camera = shot.camera.name, .frame = shot.frame});
    if (!job.written.insert(file).second) {
      throw std::runtime_error("--output: " + file.string() + " would be written twice");
    }
    if (!is_writable(file)) throw std::runtime_error("--output: cannot write " + file.string());
    files.push_back(std::move(file));
  }
  return files;
}

void write_bytes(const fs::path& path, const std::vector<std::uint8_t>& bytes) {
  if (path.empty()) {
    const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
    if (!whole || std::fflush(stdout) != 0) {
      throw std::runtime_error("cannot write to standard output");
    }
    return;
  }
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

std::vector<std::uint8_t> render_image(render::Renderer& renderer, const RenderJob& job) {
  std::uint32_t samples = 0;
  bool converged = false;
  while (!converged && samples < job.options.samples.value_or(protocol::max_samples_per_pixel)) {
    const render::Frame frame = renderer.render();
    samples = frame.samples;
    converged = frame.converged;
  }
  return session::encode_content(
      accepted(session::read_content(renderer, job.options.buffer, job.format)), job.format);
}

void print_timings(RenderJob& job, render::Renderer& renderer, const fs::path& scene,
                   const FrameSize& size) {
  nlohmann::json line =
      measure_passes(renderer, job.settings, job.options.frames.value_or(measured_frames));
  line["scene"] = scene.filename().string();
  line["device"] = job.engine->device().name;
  line["tracer"] = protocol::enum_name(job.engine->tracer());
  line["width"] = size.width;
  line["height"] = size.height;
  std::printf("%s\n", line.dump().c_str());
}

/// Settings and scene decide which buffers there are.
void check_buffer(const render::Renderer& renderer, const std::string& name) {
  const auto& buffers = renderer.buffers();
  if (std::ranges::find(buffers, name, &render::BufferInfo::name) != buffers.end()) return;
  throw std::runtime_error("--buffer: frames of this scene with these settings have no " + name);
}

void set_up_device(RenderJob& job) {
  if (job.engine) return;
  job.engine = make_engine(job.options.device);
  if (const std::string error = job.engine->shader_error(); !error.empty()) {
    throw std::runtime_error(error);
  }
}

}  // namespace

void render_scene(RenderJob& job, const fs::path& file) {
  const RenderOptions& options = job.options;
  auto scene = std::make_unique<scene::Scene>(scene::import_gltf(file, options.limits));
  const std::vector<Shot> shots = plan_shots(*scene, options);
  const std::vector<fs::path> files = choose_files(job, file, shots);
  if (const std::string note = note_on_clip(*scene, options); !note.empty()) {
    std::fprintf(stderr, "heliograph: %s: %s\n", file.c_str(), note.c_str());
  }
  auto environment = environment_of(job, file);
  set_up_device(job);
  const auto resources =
      job.engine->upload_and_free_pixels(std::move(scene), std::move(environment));
  render::Renderer renderer(*job.engine);
  const FrameSize size = frame_size(options);
  renderer.set_scene(resources);
  renderer.set_size(size.width, size.height);
  renderer.set_camera(shots.front().camera);
  accept(renderer.set_settings(job.settings));
  check_buffer(renderer, options.buffer);
  if (options.timings) {
    print_timings(job, renderer, file, size);
    // Start again without history, so that the file does not depend on --timings.
    renderer.set_scene(resources);
    accept(renderer.set_settings(job.settings));
  }
  renderer.set_frame_seconds(static_cast<float>(1.0 / options.fps));
  for (std::size_t i = 0; i < shots.size(); ++i) {
    if (i > 0 && shots[i].cut) renderer.reset();
    accept(renderer.set_pose(options.clip, shots[i].seconds));
    renderer.set_camera(shots[i].camera);
    write_bytes(files[i], render_image(renderer, job));
  }
}

}  // namespace heliograph::cli
