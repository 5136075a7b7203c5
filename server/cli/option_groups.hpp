#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "protocol/limits.hpp"

// Options that several commands share. Includes CLI11: only for the sources of this folder.

namespace heliograph::cli {

/// Accepts one of `names`; for another the error suggests the nearest.
CLI::Validator one_of(const std::vector<std::string>& names);

void add_device_options(CLI::App& command, DeviceOptions& options);
void add_shader_option(CLI::App& command, DeviceOptions& options);
void add_jpeg_option(CLI::App& command, DeviceOptions& options);
void add_settings_options(CLI::App& command, SettingsOptions& options);
/// Accepts the name of a preset.
CLI::Validator preset_name();
/// What an image shows and how good it is.
void add_view_options(CLI::App& command, RenderOptions& options);
void add_log_options(CLI::App& command, LogOptions& options);
void add_environment_option(CLI::App& command, std::string& environment);
void add_images_option(CLI::App& command, std::string& images);
/// Limits beyond which a scene file is refused.
void add_limit_options(CLI::App& command, scene::ImportLimits& limits);
/// The options that give another program of ours these limits.
std::vector<std::string> limit_arguments(const scene::ImportLimits& limits);

/// Those that make it the helper of a server that imports uploads.
std::vector<std::string> import_arguments(const scene::ImportLimits& limits, std::uint32_t seconds);

/// `Number` is an integer or an optional one; `otherwise` describes the default.
template <class Number>
void add_size_options(CLI::App& command, Number& width, Number& height,
                      const std::string& otherwise) {
  command.add_option("--width", width, "Frame width, pixels [" + otherwise + "]")
      ->check(CLI::Range(protocol::min_frame_size, protocol::max_frame_size))
      ->group("Frames");
  command.add_option("--height", height, "Frame height, pixels")
      ->check(CLI::Range(protocol::min_frame_size, protocol::max_frame_size))
      ->group("Frames");
}

/// Adds the command "serve".
CLI::App* add_serve(CLI::App& app, ServeOptions& options);
/// Adds the command "mcp".
CLI::App* add_mcp(CLI::App& app, McpOptions& options);
/// Adds the command "render".
CLI::App* add_render(CLI::App& app, RenderOptions& options);
/// Adds the command of the helper that import_arguments() start, which no help shows.
CLI::App* add_import(CLI::App& app, ImportOptions& options);
/// Adds the command "compare".
CLI::App* add_compare(CLI::App& app, CompareOptions& options);
/// Adds the command "export".
CLI::App* add_export(CLI::App& app, ExportOptions& options);

}  // namespace heliograph::cli
