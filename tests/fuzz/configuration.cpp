// Arbitrary bytes as the file of --config must give options, or a refusal. The effective
// configuration that the server prints must be such a file, with the same values.
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/config_file.hpp"
#include "input_file.hpp"

using namespace heliograph;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// A command with an option of each kind that the server's commands have.
struct Program {
  Program() {
    app.add_option("--config", config_file);
    command->add_option("--host", host)->capture_default_str();
    command->add_option("--port", port)->check(CLI::Range(0, 65535))->capture_default_str();
    command->add_option("--idle-timeout", seconds)->check(CLI::PositiveNumber);
    command->add_option("--scenes", folders)->expected(1, 8);
    command->add_option("--token", token);
    command->add_flag("--uploads", uploads);
    app.add_subcommand("render")->add_option("-o,--output", output);
    cli::name_variables(*command);
  }

  CLI::App app{"fuzzed", "heliograph"};
  CLI::App* command = app.add_subcommand("serve");
  std::string config_file, host = "127.0.0.1", token, output;
  int port = 8080;
  std::optional<double> seconds;
  std::vector<std::string> folders;
  bool uploads = false;
};

/// The text of the effective configuration; nothing where the file is refused.
std::optional<std::string> effective(Program& program, const std::string& file) {
  try {
    const cli::OptionSources sources(program.app, *program.command, {"serve", "--config", file});
    std::vector<std::string> arguments = sources.arguments();
    std::reverse(arguments.begin(), arguments.end());
    program.app.parse(arguments);
    return cli::effective_config(*program.command, sources);
  } catch (const std::invalid_argument&) {
  } catch (const CLI::ParseError&) {
  }
  return std::nullopt;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFile file("heliograph.toml");
  file.write(data, size);
  Program given;
  const auto text = effective(given, file.path());
  if (!text) return 0;
  file.write(reinterpret_cast<const std::uint8_t*>(text->data()), text->size());
  Program again;
  require(effective(again, file.path()).has_value());
  require(again.host == given.host && again.port == given.port);
  require(again.seconds == given.seconds && again.folders == given.folders);
  require(again.uploads == given.uploads);
  return 0;
}
