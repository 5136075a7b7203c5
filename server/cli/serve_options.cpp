#include <string>

#include "cli/option_groups.hpp"

namespace heliograph::cli {
namespace {

constexpr const char* examples = R"text(Examples:
  heliograph serve
  heliograph serve --scene-root ~/models --scene helmet --port 9000
  heliograph serve --set tone_map.curve=agx --set accumulation.max_samples=256
  heliograph serve --host 0.0.0.0 --token "$(openssl rand -hex 16)"
  heliograph serve --host 0.0.0.0 --token-file tokens --tls-certificate cert.pem --tls-key key.pem

Each option can also stand in the environment (HELIOGRAPH_PORT=9000) or in the file that --config
names ("[serve]" and "port=9000" on two lines). The command line comes first, then the environment,
then the file; --print-config shows what comes of them. server/README.md explains operation.)text";

void add_network_options(CLI::App& command, ServeOptions& options) {
  constexpr const char* group = "Network";
  command.add_option("--host", options.host, "Address to listen on")
      ->capture_default_str()
      ->group(group);
  command.add_option("--port", options.port, "Port to listen on; 0 takes a free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str()
      ->group(group);
  auto* const certificate =
      command
          .add_option("--tls-certificate", options.tls_certificate,
                      "Certificate chain (PEM): the port speaks HTTPS; read anew on SIGHUP")
          ->type_name("FILE")
          ->check(CLI::ExistingFile)
          ->group(group);
  command.add_option("--tls-key", options.tls_key, "The certificate's private key (PEM)")
      ->type_name("FILE")
      ->check(CLI::ExistingFile)
      ->needs(certificate)
      ->group(group);
  command
      .add_option("--metrics-listen", options.metrics_listen,
                  "Another address and port for metrics and health alone, without token, such as "
                  "127.0.0.1:9464; /metrics is then there and not on --port")
      ->type_name("ADDRESS:PORT")
      ->group(group);
  command
      .add_option(
          "--drain-notice", options.drain_notice,
          "Seconds from SIGTERM, when /health/ready fails, until viewers are asked to leave")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--drain-deadline", options.drain_deadline,
                  "Seconds that answers under way and leaving viewers have after that")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str()
      ->group(group);
}

void add_access_options(CLI::App& command, ServeOptions& options) {
  constexpr const char* group = "Access";
  command
      .add_option("--token", options.token,
                  "Secret that clients must show; needed for other addresses than loopback")
      ->group(group);
  command
      .add_option("--view-token", options.view_token,
                  "Another secret, for clients that may watch but not steer")
      ->group(group);
  command
      .add_option("--token-file", options.token_file,
                  "File with more of them: lines of \"control SECRET\" and \"view SECRET\"")
      ->type_name("FILE")
      ->check(CLI::ExistingFile)
      ->group(group);
  command
      .add_flag("--insecure", options.insecure,
                "Lets everybody who reaches the address watch and steer")
      ->group(group);
  const auto list = [&](const char* name, auto& values, const char* type, const char* help) {
    command.add_option(name, values, help)
        ->type_name(type)
        ->allow_extra_args(false)
        ->delimiter(',')
        ->group(group);
  };
  list("--allow-origin", options.allowed_origins, "ORIGIN",
       "Another site whose pages may use the server, such as https://example.org");
  list("--allow-host", options.allowed_hosts, "NAME",
       "Another name that the server goes by, such as that of a proxy");
  list("--trust-proxy", options.trusted_proxies, "ADDRESS",
       "Proxy, or range of them (10.0.0.0/8), whose X-Forwarded-For and -Proto are believed");
  list("--frame-ancestors", options.frame_ancestors, "ORIGIN",
       "Site whose pages may embed the viewer's; \"self\" is this one [none]");
}

void add_capacity_options(CLI::App& command, ServeOptions& options) {
  constexpr const char* group = "Capacity";
  command.add_option("--max-viewers", options.max_viewers, "Most viewers of a session")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--max-all-viewers", options.max_all_viewers,
                  "Most viewers of all sessions together")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->group(group);
  command.add_option("--max-sessions", options.max_sessions, "Most sessions, main included")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--max-pixels", options.max_pixels,
                  "Most pixels of the pictures of all sessions together")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--release-after", options.release_after,
                  "Seconds after which a session that nobody watches gives back the memory of its "
                  "pictures; it starts anew with its next viewer")
      ->check(CLI::Range(1, 31'536'000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--session-idle-timeout", options.session_idle_timeout,
                  "Seconds after which a session other than main ends that has no viewers and no "
                  "calls; 0: never")
      ->check(CLI::Range(0, 31'536'000))
      ->capture_default_str()
      ->group(group);
  command.add_option("--max-connections", options.max_connections, "Most connections in all")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--max-connections-per-client", options.max_connections_per_client,
                  "Most connections from one address, trusted proxies excepted")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->group(group);
}

void add_scene_options(CLI::App& command, ServeOptions& options) {
  constexpr const char* group = "Scenes";
  command.add_option("--scene", options.scene, "Scene to begin with [the demo scene]")
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--scene-root", options.scene_roots,
                  "Folder with .glb and .gltf files that may be loaded; can be repeated")
      ->type_name("FOLDER")
      ->allow_extra_args(false)
      ->group(group);
  command
      .add_option("--scene-cache-bytes", options.scene_cache_bytes,
                  "Memory of loaded scenes beyond which those that nobody watches are dropped")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->group(group);
  add_environment_option(command, options.environment);
  command
      .add_option("--uploads", options.uploads,
                  "Folder for scenes that clients may send with PUT /api/v1/scenes/NAME [none may]")
      ->type_name("FOLDER")
      ->group(group);
  command.add_option("--max-upload-bytes", options.max_upload_bytes, "Most bytes of one of them")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(group);
  command.add_option("--upload-quota", options.upload_quota, "Most bytes of them together")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(group);
}

void add_log_options(CLI::App& command, LogOptions& options) {
  constexpr const char* group = "Log";
  command.add_option("--log-format", options.format, "How the log is written to stderr")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str()
      ->group(group);
  command.add_option("--log-level", options.level, "The least important messages to log")
      ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}))
      ->capture_default_str()
      ->group(group);
}

}  // namespace

CLI::App* add_serve(CLI::App& app, ServeOptions& options) {
  CLI::App* command = app.add_subcommand("serve", "Serve the web client and stream pictures");
  add_network_options(*command, options);
  add_access_options(*command, options);
  add_capacity_options(*command, options);
  add_scene_options(*command, options);
  add_size_options(*command, options.width, options.height, "640x360 on a CPU, else 1280x720");
  add_settings_options(*command, options.settings);
  add_device_options(*command, options.device);
  add_shader_option(*command, options.device);
  add_limit_options(*command, options.limits);
  add_log_options(*command, options.log);
  command
      ->add_flag("--print-config", options.print_config,
                 "Print what is in effect and where it comes from, as a file for --config, and end")
      ->configurable(false);
  command->footer(examples);
  return command;
}

}  // namespace heliograph::cli
