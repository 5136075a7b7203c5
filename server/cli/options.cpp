#include "cli/options.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/kinds.hpp"
#include "protocol/presets.hpp"
#include "protocol/suggestions.hpp"

namespace heliograph::cli {
namespace {

constexpr const char* description =
    "Heliograph: renders glTF scenes and streams the pictures to browsers and programs.";

constexpr const char* examples = R"text(Examples:
  heliograph serve                            the demo scene at http://127.0.0.1:8080/
  heliograph render helmet.glb -o helmet.png  one picture, no network
  heliograph devices                          which Vulkan devices there are and why one is chosen

"heliograph COMMAND --help" explains each command.)text";

constexpr const char* serve_examples = R"text(Examples:
  heliograph serve
  heliograph serve --scene-root ~/models --scene helmet --port 9000
  heliograph serve --set tone_map.curve=agx --set accumulation.max_samples=256
  heliograph serve --host 0.0.0.0 --token "$(openssl rand -hex 16)"

Each option can also stand in the environment (HELIOGRAPH_PORT=9000) or in the file that --config
names ("[serve]" and "port=9000" on two lines). The command line comes first, then the environment,
then the file.)text";

constexpr const char* render_examples = R"text(Examples:
  heliograph render helmet.glb -o helmet.png --width 1920 --height 1080
  heliograph render helmet.glb -o normals.png --buffer gbuffer.normals --samples 1
  heliograph render helmet.glb -o dark.png --environment studio.hdr --set exposure.compensation=-1
  heliograph render atrium.glb -o atrium.png --timings --frames 32
  heliograph render fox.glb -o run.png --clip Run --time 0.2 --frames 24
  heliograph render pillars.glb -o svgf.png --preset svgf --set accumulation.handover=4096
  heliograph render pillars.glb -o truth.png --reference full --samples 1024)text";

constexpr const char* devices_examples = R"text(Example:
  heliograph devices --device llvmpipe)text";

constexpr const char* schema_examples = R"text(Examples:
  heliograph schema > heliograph.json    the methods (OpenRPC) and the settings (JSON Schema)
  heliograph schema --markdown           the settings as a page to read)text";

constexpr const char* health_examples = R"text(Example:
  heliograph health --url http://127.0.0.1:9000/health/ready)text";

std::vector<std::string> tracer_names() {
  std::vector<std::string> names{"auto"};
  for (const auto name : protocol::enum_names<protocol::TracerKind>()) names.emplace_back(name);
  return names;
}

void add_device_options(CLI::App& command, DeviceOptions& options) {
  command.add_option("--device", options.device, "Part of the name of the Vulkan device to use")
      ->envname("HELIOGRAPH_DEVICE");
  command.add_option("--tracer", options.tracer, "What traces rays; see \"heliograph devices\"")
      ->check(CLI::IsMember(tracer_names()))
      ->capture_default_str()
      ->envname("HELIOGRAPH_TRACER");
}

/// `Number` is an integer or an optional one; `otherwise` tells what holds without the option.
template <class Number>
void add_size_options(CLI::App& command, Number& width, Number& height,
                      const std::string& otherwise) {
  command.add_option("--width", width, "Picture width, pixels [" + otherwise + "]")
      ->check(CLI::Range(16, 16384))
      ->envname("HELIOGRAPH_WIDTH");
  command.add_option("--height", height, "Picture height, pixels")
      ->check(CLI::Range(16, 16384))
      ->envname("HELIOGRAPH_HEIGHT");
}

void add_settings_options(CLI::App& command, SettingsOptions& options) {
  std::vector<std::string> presets;
  for (const protocol::Preset& preset : protocol::presets()) presets.emplace_back(preset.name);
  command.add_option("--preset", options.preset, "A named choice of settings; --set comes on top")
      ->check(CLI::IsMember(presets))
      ->envname("HELIOGRAPH_PRESET");
  command
      .add_option("--set", options.assignments,
                  "A setting as PATH=VALUE; see \"heliograph schema\"")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false)
      ->envname("HELIOGRAPH_SET");
}

void add_environment_option(CLI::App& command, std::string& environment) {
  command
      .add_option("--environment", environment,
                  ".hdr or .exr file that lights the scenes [the one beside the scene]")
      ->type_name("FILE")
      ->check(CLI::ExistingFile)
      ->envname("HELIOGRAPH_ENVIRONMENT");
}

/// What a scene's file may cost before it is refused.
void add_limit_options(CLI::App& command, scene::ImportLimits& limits) {
  const auto add = [&](const char* name, auto& limit, const char* help, const char* variable) {
    return command.add_option(name, limit, help)
        ->check(CLI::PositiveNumber)
        ->capture_default_str()
        ->envname(variable);
  };
  add("--max-scene-bytes", limits.file_bytes, "Most bytes of a scene's files together",
      "HELIOGRAPH_MAX_SCENE_BYTES");
  add("--max-unpacked-bytes", limits.unpacked_bytes, "Most bytes its compressed buffers grow to",
      "HELIOGRAPH_MAX_UNPACKED_BYTES");
  add("--max-geometry-bytes", limits.scene_bytes,
      "Most bytes that its geometry and animations take once read",
      "HELIOGRAPH_MAX_GEOMETRY_BYTES");
  add("--max-triangles", limits.triangles, "Most triangles of a scene", "HELIOGRAPH_MAX_TRIANGLES");
  add("--max-texels", limits.texels, "Most texels of a scene's images together",
      "HELIOGRAPH_MAX_TEXELS");
  add("--max-texture-size", limits.texture_size, "Greatest width and height of an image, pixels",
      "HELIOGRAPH_MAX_TEXTURE_SIZE");
  add("--max-nodes", limits.nodes, "Most nodes of a scene", "HELIOGRAPH_MAX_NODES");
  add("--max-instances", limits.instances, "Most meshes placed in a scene",
      "HELIOGRAPH_MAX_INSTANCES");
  add("--max-node-depth", limits.node_depth, "Most levels of nodes below nodes",
      "HELIOGRAPH_MAX_NODE_DEPTH");
}

void add_log_options(CLI::App& command, LogOptions& options) {
  command.add_option("--log-format", options.format, "How the log is written to stderr")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str()
      ->envname("HELIOGRAPH_LOG_FORMAT");
  command.add_option("--log-level", options.level, "The least important messages to log")
      ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}))
      ->capture_default_str()
      ->envname("HELIOGRAPH_LOG_LEVEL");
}

void add_network_options(CLI::App& command, ServeOptions& options) {
  command.add_option("--host", options.host, "Address to listen on")
      ->capture_default_str()
      ->envname("HELIOGRAPH_HOST");
  command.add_option("--port", options.port, "Port to listen on; 0 takes a free one")
      ->capture_default_str()
      ->envname("HELIOGRAPH_PORT");
  command
      .add_option("--token", options.token,
                  "Secret that clients must show; needed for other addresses than loopback")
      ->envname("HELIOGRAPH_TOKEN");
  command
      .add_flag("--insecure", options.insecure,
                "Lets everybody who reaches the address watch and steer")
      ->envname("HELIOGRAPH_INSECURE");
  command
      .add_option("--allow-origin", options.allowed_origins,
                  "Another site whose pages may use the server, such as https://example.org")
      ->type_name("ORIGIN")
      ->allow_extra_args(false)
      ->envname("HELIOGRAPH_ALLOW_ORIGIN");
  command.add_option("--max-viewers", options.max_viewers, "Most viewers at one time")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->envname("HELIOGRAPH_MAX_VIEWERS");
}

CLI::App* add_serve(CLI::App& app, ServeOptions& options) {
  CLI::App* command = app.add_subcommand("serve", "Serve the web client and stream pictures");
  add_network_options(*command, options);
  command->add_option("--scene", options.scene, "Scene to begin with [the demo scene]")
      ->type_name("NAME")
      ->envname("HELIOGRAPH_SCENE");
  command
      ->add_option("--scene-root", options.scene_roots,
                   "Folder with .glb and .gltf files that may be loaded; can be repeated")
      ->type_name("FOLDER")
      ->allow_extra_args(false)
      ->envname("HELIOGRAPH_SCENE_ROOT");
  add_environment_option(*command, options.environment);
  add_limit_options(*command, options.limits);
  add_size_options(*command, options.width, options.height, "640x360 on a CPU, else 1280x720");
  add_settings_options(*command, options.settings);
  add_device_options(*command, options.device);
  add_log_options(*command, options.log);
  command->footer(serve_examples);
  return command;
}

CLI::App* add_render(CLI::App& app, RenderOptions& options) {
  CLI::App* command = app.add_subcommand("render", "Render one picture into a file");
  command->add_option("scene", options.scene, "A .glb or .gltf file")
      ->type_name("FILE")
      ->required();
  command->add_option("-o,--output", options.output, "PNG file to write")
      ->type_name("FILE")
      ->required();
  add_size_options(*command, options.width, options.height, "1280x720");
  command->add_option("--camera", options.camera, "Camera of the scene [its first, or all in view]")
      ->type_name("NAME");
  command->add_option("--samples", options.samples, "Samples per pixel [accumulation.max_samples]")
      ->check(CLI::Range(1, 65536));
  command
      ->add_option("--reference", options.reference,
                   "Path trace instead: the hybrid's own light paths, or all (full)")
      ->check(CLI::IsMember({"same_paths", "full"}));
  add_settings_options(*command, options.settings);
  command->add_option("--buffer", options.buffer, "Picture to write: any buffer of the renderer")
      ->capture_default_str();
  add_environment_option(*command, options.environment);
  add_limit_options(*command, options.limits);
  command->add_flag("--timings", options.timings,
                    "Print one line of JSON: median time of each pass");
  auto* const clip =
      command->add_option("--clip", options.clip, "Clip of the scene that poses it [at rest]");
  clip->type_name("NAME");
  command->add_option("--time", options.time, "Where the clip stands, seconds")
      ->check(CLI::Range(0.0, 1e6))
      ->needs(clip)
      ->capture_default_str();
  command->add_option("--fps", options.fps, "Pictures for each second of the clip")
      ->check(CLI::Range(0.1, 1000.0))
      ->needs(clip)
      ->capture_default_str();
  command
      ->add_option("--frames", options.frames,
                   "Pictures of the clip, in numbered files [1]; or frames to measure for "
                   "--timings [16]")
      ->check(CLI::Range(1, 100000));
  add_device_options(*command, options.device);
  command->footer(render_examples);
  return command;
}

CLI::App* add_devices(CLI::App& app, DevicesOptions& options) {
  CLI::App* command =
      app.add_subcommand("devices", "Tell which Vulkan devices there are and which is chosen");
  add_device_options(*command, options.device);
  command->footer(devices_examples);
  return command;
}

CLI::App* add_schema(CLI::App& app, SchemaOptions& options) {
  CLI::App* command = app.add_subcommand("schema", "Print the protocol and the settings");
  command->add_flag("--markdown", options.markdown, "The settings as a page to read");
  command->footer(schema_examples);
  return command;
}

CLI::App* add_health(CLI::App& app, HealthOptions& options) {
  CLI::App* command =
      app.add_subcommand("health", "Ask a running server whether it is ready; exits 0 or 1");
  command->add_option("--url", options.url, "Address to ask")
      ->capture_default_str()
      ->envname("HELIOGRAPH_HEALTH_URL");
  command->footer(health_examples);
  return command;
}

/// "; did you mean --port?" for an argument that nobody expected.
std::string hint(const CLI::App& app, const CLI::App* command) {
  std::vector<std::string> names;
  for (const CLI::App* level : {&app, command}) {
    if (!level) continue;
    for (const CLI::Option* option : level->get_options()) names.push_back(option->get_name());
  }
  if (!command) {
    for (const CLI::App* sub : app.get_subcommands({})) names.push_back(sub->get_name());
  }
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  for (const std::string& argument : app.remaining(true)) {
    const std::string name = argument.substr(0, argument.find('='));
    const std::string found = protocol::suggestion(name, candidates);
    if (!found.empty()) return found;
  }
  return {};
}

int report(const CLI::App& app, const CLI::App* command, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    return app.exit(error, std::cout, std::cerr);
  }
  const std::string help = command ? "heliograph " + command->get_name() : "heliograph";
  std::cerr << "heliograph: " << error.what() << hint(app, command) << " (" << help
            << " --help explains)\n";
  return 2;
}

}  // namespace

Command parse_command_line(int count, char** arguments) {
  CLI::App app(description, "heliograph");
  app.footer(examples);
  app.require_subcommand(1);
  app.fallthrough();
  app.set_version_flag("--version", "heliograph " HELIOGRAPH_VERSION);
  app.set_config("--config", "", "File with options (TOML)")->envname("HELIOGRAPH_CONFIG");

  ServeOptions serve;
  RenderOptions render;
  DevicesOptions devices;
  SchemaOptions schema;
  HealthOptions health;
  const CLI::App* serve_command = add_serve(app, serve);
  const CLI::App* render_command = add_render(app, render);
  const CLI::App* devices_command = add_devices(app, devices);
  const CLI::App* schema_command = add_schema(app, schema);
  const CLI::App* health_command = add_health(app, health);
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    return Finished{report(app, chosen.empty() ? nullptr : chosen.front(), error)};
  }
  if (*serve_command) return serve;
  if (*render_command) return render;
  if (*devices_command) return devices;
  if (*schema_command) return schema;
  if (*health_command) return health;
  return Finished{};
}

}  // namespace heliograph::cli
