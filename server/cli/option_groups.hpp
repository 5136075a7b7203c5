#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/options.hpp"

// Options that several commands have. For the sources of this folder only: it brings CLI11.

namespace heliograph::cli {

void add_device_options(CLI::App& command, DeviceOptions& options);
void add_shader_option(CLI::App& command, DeviceOptions& options);
void add_settings_options(CLI::App& command, SettingsOptions& options);
void add_environment_option(CLI::App& command, std::string& environment);
/// What a scene's file may cost before it is refused.
void add_limit_options(CLI::App& command, scene::ImportLimits& limits);

/// `Number` is an integer or an optional one; `otherwise` tells what holds without the option.
template <class Number>
void add_size_options(CLI::App& command, Number& width, Number& height,
                      const std::string& otherwise) {
  command.add_option("--width", width, "Picture width, pixels [" + otherwise + "]")
      ->check(CLI::Range(16, 16384))
      ->group("Pictures");
  command.add_option("--height", height, "Picture height, pixels")
      ->check(CLI::Range(16, 16384))
      ->group("Pictures");
}

/// Adds the command "serve".
CLI::App* add_serve(CLI::App& app, ServeOptions& options);

}  // namespace heliograph::cli
