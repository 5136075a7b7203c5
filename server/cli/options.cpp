#include "cli/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cli/config_file.hpp"
#include "cli/option_groups.hpp"
#include "protocol/json/suggestions.hpp"
#include "protocol/limits.hpp"

namespace heliograph::cli {
namespace {

constexpr int wrong_usage = 2;

constexpr const char* description =
    "Heliograph: renders glTF scenes and streams the frames to browsers and programs.";

constexpr const char* program_examples = R"text(Examples:
  heliograph serve                            the demo scene at http://127.0.0.1:8080/
  heliograph render helmet.glb -o helmet.png  one image, no network
  heliograph export helmet.glb --edits edits.json -o edited.glb
  heliograph devices                          the Vulkan devices, and why one is chosen

"heliograph COMMAND --help" explains each command.)text";

constexpr const char* devices_examples = R"text(Example:
  heliograph devices --device llvmpipe)text";

constexpr const char* schema_examples = R"text(Examples:
  heliograph schema > heliograph.json    the methods (OpenRPC) and the settings (JSON Schema)
  heliograph schema --markdown           the settings as a Markdown page)text";

constexpr const char* health_examples = R"text(Examples:
  heliograph health                    the server of the same environment and --config
  heliograph health --url http://127.0.0.1:9000)text";

CLI::App* add_devices(CLI::App& app, DevicesOptions& options) {
  CLI::App* command =
      app.add_subcommand("devices", "List the Vulkan devices and tell which one is chosen");
  add_device_options(*command, options.device);
  command->footer(devices_examples);
  return command;
}

CLI::App* add_schema(CLI::App& app, SchemaOptions& options) {
  CLI::App* command =
      app.add_subcommand("schema", "Print the description of the protocol and of the settings");
  command->add_flag("--markdown", options.markdown, "Print the settings as a Markdown page");
  command->footer(schema_examples);
  return command;
}

CLI::App* add_health(CLI::App& app, HealthOptions& options) {
  CLI::App* command =
      app.add_subcommand("health", "Query whether a running server is ready; exits with 0 or 1");
  command
      ->add_option("--url", options.url,
                   "Address to query, without a path its /health/ready [that of \"heliograph "
                   "serve\" with the same environment and --config]")
      ->envname("HELIOGRAPH_HEALTH_URL");
  command
      ->add_option("--tls-ca", options.authorities,
                   "Certificates (PEM) to trust with https:// [the system's; any on loopback]")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  command->footer(health_examples);
  return command;
}

std::vector<std::string> option_names(const CLI::App& app, const CLI::App* command) {
  std::vector<std::string> names;
  for (const CLI::App* level : {&app, command}) {
    if (!level) continue;
    for (const CLI::Option* option : level->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (!command->get_group().empty()) names.push_back(command->get_name());
  }
  return names;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool is_option(const std::string& argument) {
  return argument.size() >= 2 && argument[0] == '-';
}

/// "unknown option --widht; did you mean --width?" where that is what is wrong; otherwise empty.
std::string unknown_argument(const CLI::App& app, const CLI::App* command) {
  const std::vector<std::string> remaining = app.remaining(true);
  const auto unknown = [](std::string what, const std::string& name,
                          const std::vector<std::string>& known) {
    return what + " " + name + protocol::suggestion(name, {known.begin(), known.end()});
  };
  // What stands first where a command belongs is one, whatever options follow.
  const bool names_command = !command && !remaining.empty() && !is_option(remaining.front());
  for (const std::string& argument : remaining) {
    if (names_command || !is_option(argument)) continue;
    return unknown("unknown option", argument.substr(0, argument.find('=')),
                   option_names(app, command));
  }
  if (command) return remaining.empty() ? "" : "unexpected argument " + remaining.front();
  const std::vector<std::string> commands = command_names(app);
  if (remaining.empty()) return "a command is missing: " + joined(commands);
  return unknown("unknown command", remaining.front(), commands);
}

/// "heliograph.toml: " for an error about an option from that file. CLI11 names options only in the
/// text of its errors.
std::string location_of(const CLI::App* command, const OptionSources* sources,
                        const std::string& what) {
  if (!command || !sources) return {};
  for (const CLI::Option* option : command->get_options()) {
    const std::size_t begin = what.find(option->get_name());
    if (begin == std::string::npos) continue;
    const std::size_t end = begin + option->get_name().size();
    if (end < what.size() && (what[end] == '-' || std::isalpha(what[end]) != 0)) continue;
    const std::string source = sources->source(*option);
    return source.starts_with("in ") ? source.substr(3) + ": " : "";
  }
  return {};
}

int report(const CLI::App& app, const CLI::App* command, const OptionSources* sources,
           const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    return app.exit(error, std::cout, std::cerr);
  }
  const std::string help = command ? "heliograph " + command->get_name() : "heliograph";
  std::string what = unknown_argument(app, command);
  if (what.empty()) what = location_of(command, sources, error.what()) + error.what();
  std::cerr << "heliograph: " << what << " (" << help << " --help lists the options)\n";
  return wrong_usage;
}

bool asks_for_help(const std::vector<std::string>& arguments) {
  return std::any_of(arguments.begin(), arguments.end(), [](const std::string& argument) {
    return argument == "--help" || argument == "-h";
  });
}

/// The health address of a server with these options on this machine.
/// @throws std::invalid_argument
std::string health_url(const ServeOptions& serve) {
  if (serve.port == 0) {
    throw std::invalid_argument("--port 0 chooses another port at each start: specify --url");
  }
  std::string host = serve.host;
  // A server that listens on all addresses is queried on loopback.
  if (host == "0.0.0.0") host = "127.0.0.1";
  if (host == "::") host = "::1";
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  const std::string scheme = serve.tls_certificate.empty() ? "http" : "https";
  return scheme + "://" + host + ":" + std::to_string(serve.port) + "/health/ready";
}

/// The command in the arguments, or null.
CLI::App* named_command(CLI::App& app, const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    for (CLI::App* command : app.get_subcommands({})) {
      if (command->check_name(argument)) return command;
    }
  }
  return nullptr;
}

Command parse(const std::vector<std::string>& given);

/// The options with the address of the server that the environment and `config_file` describe.
Command with_url_of_server(HealthOptions options, const std::string& config_file) {
  std::vector<std::string> serving{"serve"};
  if (!config_file.empty()) serving.push_back("--config=" + config_file);
  const Command command = parse(serving);
  const auto* const serve = std::get_if<ServeOptions>(&command);
  if (!serve) return command;
  options.url = health_url(*serve);
  return options;
}

Command parse(const std::vector<std::string>& given) {
  CLI::App app(description, "heliograph");
  app.footer(program_examples);
  app.require_subcommand(1);
  app.fallthrough();
  app.set_version_flag("--version", "heliograph " HELIOGRAPH_VERSION);
  std::string config_file;
  app.add_option("--config", config_file,
                 "File with options (TOML), such as \"[serve]\" and \"port=9000\"")
      ->type_name("FILE")
      ->envname("HELIOGRAPH_CONFIG");

  ServeOptions serve;
  RenderOptions render;
  CompareOptions compare;
  ExportOptions exported;
  DevicesOptions devices;
  SchemaOptions schema;
  HealthOptions health;
  McpOptions mcp;
  ImportOptions import;
  const CLI::App* serve_command = add_serve(app, serve);
  const CLI::App* render_command = add_render(app, render);
  const CLI::App* compare_command = add_compare(app, compare);
  const CLI::App* export_command = add_export(app, exported);
  const CLI::App* devices_command = add_devices(app, devices);
  const CLI::App* schema_command = add_schema(app, schema);
  const CLI::App* health_command = add_health(app, health);
  const CLI::App* mcp_command = add_mcp(app, mcp);
  const CLI::App* import_command = add_import(app, import);
  for (CLI::App* command : app.get_subcommands({})) name_variables(*command);

  CLI::App* const command = named_command(app, given);
  std::optional<OptionSources> sources;
  std::vector<std::string> to_parse = given;
  try {
    if (command && !asks_for_help(given)) {
      sources.emplace(app, *command, given);
      to_parse = sources->arguments();
    }
    std::reverse(to_parse.begin(), to_parse.end());
    app.parse(std::move(to_parse));
  } catch (const CLI::ParseError& error) {
    return Finished{report(app, command, sources ? &*sources : nullptr, error)};
  } catch (const std::invalid_argument& wrong_file) {
    std::cerr << "heliograph: " << wrong_file.what() << "\n";
    return Finished{wrong_usage};
  }
  if (*serve_command && serve.print_config) {
    std::cout << effective_config(*serve_command, *sources);
    return Finished{};
  }
  if (*serve_command) return serve;
  if (*render_command) return render;
  if (*compare_command) return compare;
  if (*export_command) return exported;
  if (*devices_command) return devices;
  if (*schema_command) return schema;
  if (*mcp_command) return mcp;
  if (*import_command) return import;
  if (*health_command) {
    return health.url.empty() ? with_url_of_server(health, config_file) : Command(health);
  }
  return Finished{};
}

}  // namespace

Command parse_command_line(int count, char** arguments) {
  return parse({arguments + std::min(count, 1), arguments + count});
}

}  // namespace heliograph::cli
