#include "cli/config_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "protocol/json/suggestions.hpp"

namespace heliograph::cli {
namespace {

constexpr std::array<std::string_view, 3> secrets{"token", "view-token", "webhook-secret"};
constexpr const char* config_variable = "HELIOGRAPH_CONFIG";

std::string variable(const std::string& name) {
  const char* const value = name.empty() ? nullptr : std::getenv(name.c_str());
  return value ? value : "";
}

/// The value of --config, wherever it is given.
std::string config_path(const std::vector<std::string>& arguments) {
  constexpr std::string_view name = "--config";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == name && i + 1 < arguments.size()) return arguments[i + 1];
    if (arguments[i].starts_with("--config=")) return arguments[i].substr(name.size() + 1);
  }
  return variable(config_variable);
}

/// The option with the key `name` in files.
const CLI::Option* find_option(const CLI::App& command, const std::string& name) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_configurable() && option->check_lname(name)) return option;
  }
  return nullptr;
}

std::string unknown_key(const std::vector<const CLI::App*>& commands, const std::string& key) {
  std::vector<std::string_view> names;
  std::vector<std::string> kept;
  for (const CLI::App* command : commands) {
    for (const CLI::Option* option : command->get_options()) {
      if (option->get_configurable() && !option->get_lnames().empty()) {
        kept.push_back(option->get_lnames().front());
      }
    }
  }
  names.assign(kept.begin(), kept.end());
  return "\"" + key + "\" is not an option" + protocol::suggestion(key, names);
}

bool is_plain(const std::string& value) {
  if (value == "true" || value == "false") return true;
  char* end = nullptr;
  std::strtod(value.c_str(), &end);
  return !value.empty() && end == value.c_str() + value.size() &&
         std::isalpha(static_cast<unsigned char>(value.back())) == 0;
}

std::string toml_text(const std::string& value) {
  return is_plain(value) ? value : "\"" + value + "\"";
}

std::string toml_value(const CLI::Option& option) {
  const bool list = option.get_expected_max() > 1;
  std::vector<std::string> values = option.results();
  if (values.empty() && !list) values = {option.get_default_str()};
  if (!list) return toml_text(values.back());
  std::string text;
  for (const std::string& value : values) text += (text.empty() ? "" : ", ") + toml_text(value);
  return "[" + text + "]";
}

}  // namespace

OptionSources::OptionSources(const CLI::App& app, const CLI::App& command,
                             std::vector<std::string> arguments)
    : given_(std::move(arguments)), arguments_(given_), file_(config_path(given_)) {
  if (!file_.empty()) read_file(app, command);
}

void OptionSources::read_file(const CLI::App& app, const CLI::App& command) {
  std::ifstream stream(file_);
  if (!stream) throw std::invalid_argument("--config: cannot read " + file_);
  const std::vector<const CLI::App*> commands = app.get_subcommands(nullptr);
  for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_config(stream)) {
    if (item.name == "++" || item.name == "--") continue;
    std::vector<const CLI::App*> meant = commands;
    if (!item.parents.empty()) {
      std::erase_if(meant, [&](const CLI::App* one) {
        return item.parents.size() > 1 || one->get_name() != item.parents.front();
      });
      if (meant.empty()) {
        throw std::invalid_argument(file_ + ": [" + item.parents.front() + "] is not a command");
      }
    }
    const bool known = std::any_of(meant.begin(), meant.end(), [&](const CLI::App* one) {
      return find_option(*one, item.name) != nullptr;
    });
    if (!known) throw std::invalid_argument(file_ + ": " + unknown_key(meant, item.name));
    if (std::find(meant.begin(), meant.end(), &command) != meant.end()) take(command, item);
  }
}

void OptionSources::take(const CLI::App& command, const CLI::ConfigItem& item) {
  const CLI::Option* const option = find_option(command, item.name);
  if (!option || on_command_line(*option) || !variable(option->get_envname()).empty()) return;
  from_file_.push_back(option->get_name());
  for (const std::string& value : item.inputs) {
    arguments_.push_back(option->get_name() + "=" + value);
  }
}

bool OptionSources::on_command_line(const CLI::Option& option) const {
  return std::any_of(given_.begin(), given_.end(), [&](const std::string& argument) {
    const std::string name = argument.substr(0, argument.find('='));
    return name.starts_with("--")
               ? option.check_lname(name.substr(2))
               : name.size() > 1 && name[0] == '-' && option.check_sname(name.substr(1, 1));
  });
}

std::string OptionSources::source(const CLI::Option& option) const {
  if (on_command_line(option)) return "on the command line";
  if (!variable(option.get_envname()).empty()) return "in " + option.get_envname();
  const bool in_file =
      std::find(from_file_.begin(), from_file_.end(), option.get_name()) != from_file_.end();
  return in_file ? "in " + file_ : "";
}

std::string effective_config(const CLI::App& command, const OptionSources& sources) {
  std::ostringstream text;
  text << "[" << command.get_name() << "]\n";
  std::string group;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_configurable() || option->get_lnames().empty()) continue;
    if (option->get_group() != group) text << "\n# " << (group = option->get_group()) << "\n";
    const std::string& name = option->get_lnames().front();
    const std::string source = sources.source(*option);
    if (std::find(secrets.begin(), secrets.end(), name) != secrets.end()) {
      text << "# " << name << " is " << (source.empty() ? "not given" : "given " + source) << "\n";
    } else if (source.empty() && option->get_default_str().empty() &&
               option->get_expected_max() > 0) {
      text << "# " << name << " is not given\n";
    } else {
      const bool flag = option->get_expected_max() == 0;
      text << name << " = " << (flag && source.empty() ? "false" : toml_value(*option));
      text << (source.empty() ? "" : "  # " + source) << "\n";
    }
  }
  return text.str();
}

void name_variables(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    const bool named = !option->get_envname().empty();
    if (named || option->get_lnames().empty() || !option->get_configurable()) continue;
    std::string name = "HELIOGRAPH_" + option->get_lnames().front();
    for (char& c : name) {
      c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    option->envname(name);
  }
}

}  // namespace heliograph::cli
