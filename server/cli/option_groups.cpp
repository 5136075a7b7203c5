#include "cli/option_groups.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "protocol/json/suggestions.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/settings/presets.hpp"

namespace heliograph::cli {
namespace {

std::vector<std::string> tracer_names() {
  std::vector<std::string> names{"auto"};
  for (const auto name : protocol::enum_names<protocol::TracerKind>()) names.emplace_back(name);
  return names;
}

constexpr const char* import_command = "import-for-server";
constexpr const char* strict_assets = "--strict-assets";

/// The options of limits that are numbers: name, value and help.
template <class Limits, class Visit>
void visit_limits(Limits& limits, Visit visit) {
  visit("--max-scene-bytes", limits.file_bytes, "Maximum bytes of a scene's files");
  visit("--max-unpacked-bytes", limits.unpacked_bytes, "Maximum bytes of its decompressed buffers");
  visit("--max-geometry-bytes", limits.scene_bytes,
        "Maximum bytes of its geometry and animations in memory");
  visit("--max-triangles", limits.triangles, "Maximum number of triangles of a scene");
  visit("--max-texels", limits.texels, "Maximum number of texels of a scene's images");
  visit("--max-texture-size", limits.texture_size,
        "Maximum width and height of a texture image, pixels");
  visit("--max-nodes", limits.nodes, "Maximum number of nodes of a scene");
  visit("--max-instances", limits.instances, "Maximum number of mesh instances of a scene");
  visit("--max-node-depth", limits.node_depth, "Maximum depth of the node hierarchy");
}

}  // namespace

CLI::Validator one_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ",") + name;
  return CLI::Validator(
      [names, list](const std::string& value) -> std::string {
        if (std::find(names.begin(), names.end(), value) != names.end()) return {};
        return value + " is not one of " + list +
               protocol::suggestion(value, {names.begin(), names.end()});
      },
      "{" + list + "}");
}

void add_device_options(CLI::App& command, DeviceOptions& options) {
  command
      .add_option("--device", options.devices,
                  "Part of the name of the Vulkan device to use; \"serve\" takes several, "
                  "separated by commas, or all: every GPU; other commands use the first")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->group("Device");
  command.add_option("--tracer", options.tracer, "Ray tracer; see \"heliograph devices\"")
      ->check(one_of(tracer_names()))
      ->capture_default_str()
      ->group("Device");
  command
      .add_option("--compressed-textures", options.compressed_textures,
                  "Whether textures of KTX2 files stay compressed on the device (BC7, a quarter of "
                  "the memory), unless that loses too much; automatic: on GPUs that read it")
      ->check(one_of({"automatic", "on", "off"}))
      ->capture_default_str()
      ->group("Device");
}

void add_shader_option(CLI::App& command, DeviceOptions& options) {
  command
      .add_option(
          "--shader-dir", options.shader_dir,
          "Folder of GLSL sources (a checkout's shaders/) that replace all built-in shaders: "
          "compute, raster and ray tracing stages, and host kernels. \"serve\" compiles "
          "again when a file is saved; errors are shown over the frame and logged. "
          "Environments and lookup tables keep the shaders they were made with; bindings, "
          "push constants and workgroup sizes must stay; Embree runs no shaders")
      ->type_name("FOLDER")
      ->check(CLI::ExistingDirectory)
      ->group("Device");
}

void add_jpeg_option(CLI::App& command, DeviceOptions& options) {
  command
      .add_option("--gpu-jpeg", options.gpu_jpeg,
                  "Whether the device encodes the JPEG frames that all viewers of a session "
                  "share, so that no pixels are copied from it; automatic: where it is a GPU")
      ->check(one_of({"automatic", "on", "off"}))
      ->capture_default_str()
      ->group("Device");
}

CLI::Validator preset_name() {
  std::vector<std::string> presets;
  for (const protocol::Preset& preset : protocol::presets()) presets.emplace_back(preset.name);
  return one_of(presets);
}

void add_settings_options(CLI::App& command, SettingsOptions& options) {
  command.add_option("--preset", options.preset, "Preset of the denoiser; --set is applied on top")
      ->check(preset_name())
      ->group("Frames");
  command
      .add_option("--set", options.assignments,
                  "A setting as PATH=VALUE; see \"heliograph schema\"")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false)
      ->group("Frames");
}

void add_log_options(CLI::App& command, LogOptions& options) {
  constexpr const char* group = "Log";
  command.add_option("--log-format", options.format, "Format of the log on stderr")
      ->check(one_of({"text", "json"}))
      ->capture_default_str()
      ->group(group);
  command.add_option("--log-level", options.level, "Minimum level of logged messages")
      ->check(one_of({"debug", "info", "warning", "error", "off"}))
      ->capture_default_str()
      ->group(group);
}

void add_environment_option(CLI::App& command, std::string& environment) {
  command
      .add_option("--environment", environment,
                  ".hdr or .exr file that lights the scenes [the light in the scene's file, or the "
                  "one next to it]")
      ->type_name("FILE")
      ->check(CLI::ExistingFile)
      ->group("Scenes");
}

void add_images_option(CLI::App& command, std::string& images) {
  command
      .add_option("--images", images,
                  "Folder with the images that edits put in the place of textures "
                  "[that of the edits, then that of the scene]")
      ->type_name("FOLDER")
      ->check(CLI::ExistingDirectory);
}

void add_limit_options(CLI::App& command, scene::ImportLimits& limits) {
  constexpr const char* group = "Limits of scenes";
  visit_limits(limits, [&](const char* name, auto& limit, const char* help) {
    command.add_option(name, limit, help)
        ->check(CLI::PositiveNumber)
        ->capture_default_str()
        ->group(group);
  });
  command
      .add_flag(strict_assets, limits.strict_assets,
                "Refuse scenes with missing or damaged images instead of showing them without")
      ->group(group);
}

std::vector<std::string> limit_arguments(const scene::ImportLimits& limits) {
  std::vector<std::string> arguments;
  visit_limits(limits, [&](const char* name, auto limit, const char*) {
    arguments.insert(arguments.end(), {name, std::to_string(limit)});
  });
  if (limits.strict_assets) arguments.emplace_back(strict_assets);
  return arguments;
}

std::vector<std::string> import_arguments(const scene::ImportLimits& limits,
                                          std::uint32_t seconds) {
  std::vector<std::string> arguments{import_command, "--seconds", std::to_string(seconds)};
  const std::vector<std::string> more = limit_arguments(limits);
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

CLI::App* add_import(CLI::App& app, ImportOptions& options) {
  CLI::App* command = app.add_subcommand(import_command, "Import files for a server");
  command->group("");
  command->add_option("--seconds", options.seconds, "Of one import")->required();
  add_limit_options(*command, options.limits);
  return command;
}

}  // namespace heliograph::cli
