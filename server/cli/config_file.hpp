#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

// The file of --config, the environment, and the source of each option's value. Includes CLI11:
// only for the sources of this folder.

namespace heliograph::cli {

/// The sources of the values of one command's options. The command line takes precedence over the
/// environment, the environment over the file.
class OptionSources {
 public:
  /// `arguments` are those of the process, without its name.
  /// @throws std::invalid_argument naming file and key, if the file cannot be read or has unknown
  /// keys
  OptionSources(const CLI::App& app, const CLI::App& command, std::vector<std::string> arguments);

  /// The command line, with the file's options appended where nothing takes precedence.
  const std::vector<std::string>& arguments() const { return arguments_; }
  /// "on the command line", "in HELIOGRAPH_PORT", "in heliograph.toml" or empty for the default.
  std::string source(const CLI::Option& option) const;

 private:
  void read_file(const CLI::App& app, const CLI::App& command);
  void take(const CLI::App& command, const CLI::ConfigItem& item);
  bool on_command_line(const CLI::Option& option) const;

  const std::vector<std::string> given_;
  std::vector<std::string> arguments_;
  std::string file_;  // empty: none
  std::vector<std::string> from_file_;
};

/// The values of the command's options as a file for --config, with the source of each as a
/// comment. Secrets are omitted.
std::string effective_config(const CLI::App& command, const OptionSources& sources);

/// HELIOGRAPH_MAX_VIEWERS for --max-viewers, for every option without a variable.
void name_variables(CLI::App& command);

}  // namespace heliograph::cli
