#include <CLI/CLI.hpp>

#include "cli/option_groups.hpp"

namespace heliograph::cli {
namespace {

constexpr const char* mcp_examples = R"text(Examples:
  heliograph mcp --scene-root models      started by an agent: messages on stdin and stdout
  heliograph mcp --scene helmet --width 800 --height 600)text";

}  // namespace

CLI::App* add_mcp(CLI::App& app, McpOptions& options) {
  CLI::App* command = app.add_subcommand("mcp",
                                         "Serve the methods to an agent as tools of the Model "
                                         "Context Protocol, on stdio; a server does so at /mcp");
  constexpr const char* group = "Scenes";
  command->add_option("--scene", options.scene, "Scene to load at the start [the demo scene]")
      ->type_name("NAME")
      ->group(group);
  command
      ->add_option("--scene-root", options.scene_roots,
                   "Folder with .glb and .gltf files that can be loaded; can be repeated")
      ->type_name("FOLDER")
      ->allow_extra_args(false)
      ->group(group);
  add_environment_option(*command, options.environment);
  add_size_options(*command, options.width, options.height, "640x360");
  add_settings_options(*command, options.settings);
  add_device_options(*command, options.device);
  add_limit_options(*command, options.limits);
  add_log_options(*command, options.log);
  command->footer(mcp_examples);
  return command;
}

}  // namespace heliograph::cli
