#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

#include "cli/commands.hpp"
#include "cli/engine_options.hpp"
#include "cli/log.hpp"
#include "cli/render_scene.hpp"
#include "render/api/buffer_names.hpp"
#include "scene/environment.hpp"

namespace heliograph::cli {
namespace {

constexpr int some_failed = 3;

protocol::ImageFormat format_of(const RenderOptions& options, const OutputName& output) {
  std::string name = options.format;
  if (name.empty() && output.is_standard_output()) name = "png";
  if (name.empty()) {
    const std::string extension = output.extension();
    name = extension.substr(std::min<std::size_t>(extension.size(), 1));
  }
  if (name == "jpg") return protocol::ImageFormat::jpeg;
  if (const auto format = protocol::enum_value<protocol::ImageFormat>(name)) return *format;
  throw std::invalid_argument("--output: must be a .png, .jpg, .exr or .npy file, not " +
                              options.output);
}

protocol::Settings settings_of(const RenderOptions& options) {
  protocol::Settings settings = parse_settings(options.settings);
  if (!options.reference.empty()) {
    settings.reference.use = protocol::ReferenceUse::always;
    settings.reference.scope = options.reference == "full" ? protocol::ReferenceScope::full
                                                           : protocol::ReferenceScope::same_paths;
  }
  if (options.samples) settings.accumulation.max_samples = static_cast<int>(*options.samples);
  return settings;
}

/// The name of the files, which tells all images apart.
OutputName output_of(const RenderOptions& options) {
  OutputName output(options.output);
  const bool frames = options.turntable.has_value() ||
                      (!options.clip.empty() && options.frames.value_or(1) > 1 && !options.timings);
  const bool cameras = options.camera == "all";
  if (output.is_standard_output()) {
    if (options.timings) throw std::invalid_argument("--timings prints to standard output, too");
    if (frames || cameras || options.scenes.size() > 1) {
      throw std::invalid_argument("--output: standard output takes one image only");
    }
    return output;
  }
  if (options.scenes.size() > 1 && !output.has_scene()) {
    throw std::invalid_argument(
        "--output: several scenes need {scene} in the name, such as {scene}.png");
  }
  if (cameras && !output.has_camera()) {
    throw std::invalid_argument(
        "--output: --camera all needs {camera} in the name, such as {scene}_{camera}.png");
  }
  if (frames && !output.has_frame()) output.add_frame();
  return output;
}

void check_folder(const std::filesystem::path& folder) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error("--output: cannot write into " + folder.string() + ": " + why);
  };
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) refuse("there is no such folder");
  if (access(folder.c_str(), W_OK | X_OK) != 0) refuse(std::strerror(errno));
}

void check_combination(const RenderOptions& options) {
  if (options.frames && options.clip.empty() && !options.timings) {
    throw std::invalid_argument("--frames: needs --clip, or --timings; --turntable has its own");
  }
}

std::shared_ptr<const scene::Environment> environment_of(const RenderOptions& options) {
  if (options.environment.empty()) return nullptr;
  return std::make_shared<const scene::Environment>(scene::load_environment(options.environment));
}

RenderJob make_job(const RenderOptions& options) {
  check_combination(options);
  const OutputName output = output_of(options);
  const protocol::ImageFormat format = format_of(options, output);
  if (!output.is_standard_output()) check_folder(output.folder());
  const auto named = render::check_buffer_name(options.buffer, "--buffer");
  if (!named) throw std::invalid_argument(named.error().message);
  return {.options = options,
          .output = output,
          .format = format,
          .settings = settings_of(options),
          .environment = environment_of(options)};
}

}  // namespace

int run(const RenderOptions& options) {
  set_up_log({.level = "warning"});  // standard output may be an image
  RenderJob job = make_job(options);
  std::size_t failed = 0;
  for (const std::filesystem::path& scene : options.scenes) {
    try {
      render_scene(job, scene);
    } catch (const std::exception& failure) {
      std::fprintf(stderr, "heliograph: %s: %s\n", scene.c_str(), failure.what());
      ++failed;
    }
  }
  if (failed == 0) return 0;
  if (options.scenes.size() > 1) {
    std::fprintf(stderr, "heliograph: %zu of %zu scenes failed\n", failed, options.scenes.size());
  }
  return failed == options.scenes.size() ? 1 : some_failed;
}

}  // namespace heliograph::cli
