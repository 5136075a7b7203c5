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

Each option can also be set in the environment (HELIOGRAPH_PORT=9000) or in the file of --config
("[serve]" and "port=9000" on two lines). The command line takes precedence over the environment, the
environment over the file; --print-config shows the result. server/README.md describes operation.)text";

void add_network_options(CLI::App& command, ServeOptions& options) {
  constexpr const char* group = "Network";
  command.add_option("--host", options.host, "Address to listen on")
      ->capture_default_str()
      ->group(group);
  command.add_option("--port", options.port, "Port to listen on; 0 chooses a free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str()
      ->group(group);
  auto* const certificate =
      command
          .add_option("--tls-certificate", options.tls_certificate,
                      "Certificate chain (PEM); enables HTTPS; reloaded on SIGHUP")
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
                  "Separate address and port for metrics and health, without token, such as "
                  "127.0.0.1:9464; moves /metrics there from --port")
      ->type_name("ADDRESS:PORT")
      ->group(group);
  command
      .add_option("--drain-notice", options.drain_notice,
                  "Seconds between SIGTERM, when /health/ready fails, and closing connections")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--drain-deadline", options.drain_deadline,
                  "Seconds after that for pending responses and closing connections")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str()
      ->group(group);
}

void add_access_options(CLI::App& command, ServeOptions& options) {
  constexpr const char* group = "Access";
  command
      .add_option("--token", options.token,
                  "Secret that clients must present; required for addresses other than loopback")
      ->group(group);
  command.add_option("--view-token", options.view_token, "Secret for read-only clients")
      ->group(group);
  command
      .add_option("--token-file", options.token_file,
                  "File with further tokens: lines of \"control SECRET\" and \"view SECRET\"")
      ->type_name("FILE")
      ->check(CLI::ExistingFile)
      ->group(group);
  command
      .add_option("--annotate", options.annotate,
                  "Who may measure and annotate: clients that have control of the session, or "
                  "everyone, also with a view token")
      ->check(one_of({"control", "everyone"}))
      ->capture_default_str()
      ->group(group);
  command
      .add_flag("--insecure", options.insecure,
                "Allow clients without a token, on any address, to view and control")
      ->group(group);
  const auto list = [&](const char* name, auto& values, const char* type, const char* help) {
    command.add_option(name, values, help)
        ->type_name(type)
        ->allow_extra_args(false)
        ->delimiter(',')
        ->group(group);
  };
  list("--allow-origin", options.allowed_origins, "ORIGIN",
       "Further site whose pages may use the server, such as https://example.org");
  list("--allow-host", options.allowed_hosts, "NAME",
       "Further host name of the server, such as that of a proxy");
  list("--trust-proxy", options.trusted_proxies, "ADDRESS",
       "Proxy or address range (10.0.0.0/8) whose X-Forwarded-For and -Proto are trusted");
  list("--frame-ancestors", options.frame_ancestors, "ORIGIN",
       "Site whose pages may embed the web client; \"self\" is the server's own [none]");
}

void add_capacity_options(CLI::App& command, ServeOptions& options) {
  constexpr const char* group = "Capacity";
  command
      .add_option("--max-viewers", options.max_viewers, "Maximum number of viewers of a session")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--max-all-viewers", options.max_all_viewers,
                  "Maximum number of viewers over all sessions")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--max-sessions", options.max_sessions,
                  "Maximum number of sessions, including main")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--max-pixels", options.max_pixels,
                  "Maximum sum of the frame sizes of all sessions, pixels")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--release-after", options.release_after,
                  "Seconds after which a session without viewers releases its images; they are "
                  "created again for the next viewer")
      ->check(CLI::Range(1, 31'536'000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--session-idle-timeout", options.session_idle_timeout,
                  "Seconds without viewers and calls after which a session other than main is "
                  "closed; 0: never")
      ->check(CLI::Range(0, 31'536'000))
      ->capture_default_str()
      ->group(group);
  command.add_option("--max-connections", options.max_connections, "Maximum number of connections")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--max-connections-per-client", options.max_connections_per_client,
                  "Maximum number of connections per address, except trusted proxies")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->group(group);
}

void add_scene_options(CLI::App& command, ServeOptions& options) {
  constexpr const char* group = "Scenes";
  command.add_option("--scene", options.scene, "Scene to load at the start [the demo scene]")
      ->type_name("NAME")
      ->group(group);
  command
      .add_option("--scene-root", options.scene_roots,
                  "Folder with .glb and .gltf files that can be loaded; can be repeated")
      ->type_name("FOLDER")
      ->allow_extra_args(false)
      ->group(group);
  command
      .add_option("--scene-cache-bytes", options.scene_cache_bytes,
                  "Memory of loaded scenes above which unused scenes are released, bytes")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->group(group);
  add_environment_option(command, options.environment);
  command
      .add_option("--uploads", options.uploads,
                  "Folder for scenes, environments and images that clients upload with PUT "
                  "/api/v1/scenes/NAME, /api/v1/environments/NAME and /api/v1/images/NAME "
                  "[no uploads]")
      ->type_name("FOLDER")
      ->group(group);
  command
      .add_option("--max-upload-bytes", options.max_upload_bytes,
                  "Maximum bytes of an uploaded file")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--max-import-seconds", options.import_seconds,
                  "Seconds after which the import of an uploaded file is given up")
      ->check(CLI::Range(1, 3600))
      ->capture_default_str()
      ->group(group);
  command.add_option("--upload-quota", options.upload_quota, "Maximum bytes of all uploaded files")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(group);
}

void add_job_options(CLI::App& command, ServeOptions& options) {
  constexpr const char* group = "Jobs";
  auto* const folder = command.add_option(
      "--jobs", options.jobs,
      "Folder for jobs that clients create with POST /api/v1/jobs, and for their files [no jobs]");
  folder->type_name("FOLDER")->group(group);
  command.add_option("--job-quota", options.job_quota, "Maximum bytes of the files of all jobs")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--max-waiting-jobs", options.max_waiting_jobs, "Maximum number of queued jobs")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--keep-jobs", options.keep_jobs,
                  "Seconds after which a job that has ended is forgotten with its files")
      ->check(CLI::Range(1, 31'536'000))
      ->capture_default_str()
      ->group(group);
  auto* const secret = command.add_option("--webhook-secret", options.webhook_secret,
                                          "Key of the signatures of webhooks (HMAC-SHA256)");
  secret->group(group);
  command
      .add_option("--webhook-host", options.webhook_hosts,
                  "Host that jobs may tell when they have ended [none]")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->delimiter(',')
      ->needs(secret)
      ->group(group);
}

}  // namespace

CLI::App* add_serve(CLI::App& app, ServeOptions& options) {
  CLI::App* command = app.add_subcommand("serve", "Serve the web client and stream frames");
  add_network_options(*command, options);
  add_access_options(*command, options);
  add_capacity_options(*command, options);
  add_scene_options(*command, options);
  add_job_options(*command, options);
  add_size_options(*command, options.width, options.height, "640x360 on a CPU, else 1280x720");
  add_settings_options(*command, options.settings);
  add_device_options(*command, options.device);
  add_shader_option(*command, options.device);
  add_jpeg_option(*command, options.device);
  add_limit_options(*command, options.limits);
  add_log_options(*command, options.log);
  command
      ->add_flag("--print-config", options.print_config,
                 "Print the effective options and their sources as a file for --config, and exit")
      ->configurable(false);
  command->footer(examples);
  return command;
}

}  // namespace heliograph::cli
