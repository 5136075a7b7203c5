#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/messages/render_messages.hpp"
#include "scene/import.hpp"

namespace heliograph::cli {

struct LogOptions {
  std::string format = "text";  // text or json
  std::string level = "info";
};

struct DeviceOptions {
  std::vector<std::string> devices;  // as given; device_names() tells them apart
  std::string tracer = "auto";
  std::string shader_dir;        // empty: the embedded shaders
  std::string gpu_jpeg = "off";  // for viewers, whom only a server has
  std::string compressed_textures = "automatic";
};

struct SettingsOptions {
  std::string preset;
  std::vector<std::string> assignments;  // path=value, on top of the preset
};

struct ServeOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 8080;
  std::string scene;
  std::vector<std::filesystem::path> scene_roots;
  std::string uploads;  // folder; empty: uploads are not allowed
  std::uint64_t max_upload_bytes = 256ull << 20;
  std::uint64_t upload_quota = 4ull << 30;
  std::uint32_t import_seconds = 120;  // of an uploaded file
  std::string jobs;                    // folder; empty: there are no jobs
  std::uint64_t job_quota = 4ull << 30;
  std::uint64_t max_waiting_jobs = 10000;
  std::uint32_t keep_jobs = 7 * 86400;  // seconds
  std::vector<std::string> webhook_hosts;
  std::string webhook_secret;
  std::string environment;
  std::optional<std::uint32_t> width;  // absent: depends on the device
  std::optional<std::uint32_t> height;
  std::string tls_certificate;
  std::string tls_key;
  std::string metrics_listen;  // "address:port"
  double drain_notice = 0.0;   // seconds
  double drain_deadline = 5.0;
  std::uint32_t max_viewers = 32;  // of a session
  std::uint32_t max_all_viewers = 256;
  std::uint32_t max_sessions = 64;
  std::uint64_t max_pixels = 8ull * 3840 * 2160;
  std::uint32_t release_after = 120;         // seconds
  std::uint32_t session_idle_timeout = 600;  // seconds; 0: never
  std::uint32_t max_connections = 256;
  std::uint32_t max_connections_per_client = 64;
  std::string token;
  std::string view_token;
  std::string token_file;
  std::string annotate = "control";
  bool insecure = false;
  std::vector<std::string> allowed_origins;
  std::vector<std::string> allowed_hosts;
  std::vector<std::string> trusted_proxies;
  std::vector<std::string> frame_ancestors;
  scene::ImportLimits limits;
  std::uint64_t scene_cache_bytes = 1ull << 30;
  SettingsOptions settings;
  DeviceOptions device{.gpu_jpeg = "automatic"};
  LogOptions log;
  bool print_config = false;  // instead of serving
};

struct RenderOptions {
  std::vector<std::filesystem::path> scenes;
  std::string manifest;             // file of entries; empty: none
  protocol::RenderRequest request;  // of every scene; what an entry of the manifest lacks
  std::string format;               // empty: by the extension of the output
  std::string reference;            // reference.scope; empty: no path tracing
  std::string edits;                // file; empty: none
  std::string images;               // folder; empty: those of the edits and of the scene
  std::string path;                 // file of a camera path; empty: none
  std::string orbit;                // AZIMUTH,ELEVATION; empty: none
  SettingsOptions settings;
  scene::ImportLimits limits;
  bool resume = false;  // keeps files that exist
  std::string shard;    // "I/N": every Nth entry from the Ith on
  std::string report;   // file to write; empty: none
  std::string progress = "auto";
  bool timings = false;
  DeviceOptions device;
};

struct CompareOptions {
  std::string first;   // scene file, image file, or the address of a server
  std::string second;  // empty: the first with the second preset
  std::string second_preset;
  double least_ssim = 0.98;
  double most_flip = 1.0;
  std::string report;  // HTML file to write; empty: none
  std::string token;
  std::string authorities;  // file; empty: the system's
  RenderOptions render;     // of scenes, both
};

struct ExportOptions {
  std::string scene;    // file
  std::string variant;  // of its materials; empty: the file's own
  std::string edits;    // file; empty: none
  std::string images;   // folder; empty: those of the edits and of the scene
  std::string output;
  scene::ImportLimits limits;
};

struct DevicesOptions {
  DeviceOptions device;
};

struct SchemaOptions {
  bool markdown = false;
};

struct HealthOptions {
  std::string url;          // without --url: that of a server with the same configuration
  std::string authorities;  // file; empty: the system's
};

/// Of the helper of a server that imports uploads.
struct ImportOptions {
  scene::ImportLimits limits;
  std::uint32_t seconds = 0;  // of one import
};

struct McpOptions {
  std::string scene;
  std::vector<std::filesystem::path> scene_roots;
  std::string environment;
  std::optional<std::uint32_t> width;
  std::optional<std::uint32_t> height;
  scene::ImportLimits limits;
  SettingsOptions settings;
  DeviceOptions device;
  LogOptions log;
};

/// The result of a command line that needs no command: help was printed, or the arguments are
/// wrong.
struct Finished {
  int exit_code = 0;
};

using Command =
    std::variant<Finished, ServeOptions, RenderOptions, CompareOptions, ExportOptions,
                 DevicesOptions, SchemaOptions, HealthOptions, ImportOptions, McpOptions>;

/// Reads the command line, HELIOGRAPH_* variables and the file of --config, in this order of
/// precedence. Help is printed to stdout, errors to stderr with the nearest known name.
Command parse_command_line(int count, char** arguments);

}  // namespace heliograph::cli
