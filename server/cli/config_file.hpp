#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

// The file of --config, the environment and where each option's value comes from. For the sources
// of this folder only: it brings CLI11.

namespace heliograph::cli {

/// Where the values of one command's options come from. The command line goes before the
/// environment, the environment before the file.
class OptionSources {
 public:
  /// `arguments` are those of the process, without its name.
  /// @throws std::invalid_argument naming file and key, for a file that cannot be read or that has
  /// keys that are no options
  OptionSources(const CLI::App& app, const CLI::App& command, std::vector<std::string> arguments);

  /// The command line as if the file's options stood on it, where nothing goes before them.
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

/// What the command's options are, as a file for --config with the source of each in a comment.
/// Secrets are left out.
std::string effective_config(const CLI::App& command, const OptionSources& sources);

/// HELIOGRAPH_MAX_VIEWERS for --max-viewers, for every option that has no variable yet.
void name_variables(CLI::App& command);

}  // namespace heliograph::cli
