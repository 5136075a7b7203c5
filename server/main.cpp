#include <cstdio>
#include <exception>
#include <variant>

#include "cli/commands.hpp"

int main(int count, char** arguments) {
  try {
    const heliograph::cli::Command command = heliograph::cli::parse_command_line(count, arguments);
    return std::visit([](const auto& options) { return heliograph::cli::run(options); }, command);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph: %s\n", failure.what());
    return 1;
  }
}
