#include "cli/option_groups.hpp"

namespace heliograph::cli {
namespace {

constexpr const char* compare_examples = R"text(Examples:
  heliograph compare old.glb new.glb --report comparison.html
  heliograph compare helmet.glb --preset svgf --second-preset best --samples 8
  heliograph compare helmet.glb helmet.png --ssim 0.95 --camera front
  heliograph compare http://127.0.0.1:8080 http://127.0.0.1:8081 --samples 64

The status is 0 if all images are similar, 1 if one differs, 2 if they cannot be compared.)text";

}  // namespace

CLI::App* add_compare(CLI::App& app, CompareOptions& options) {
  CLI::App* command =
      app.add_subcommand("compare", "Compare the images of two scenes, servers, presets or files");
  command
      ->add_option("first", options.first, "A .glb or .gltf file, a server's address, or an image")
      ->type_name("SOURCE")
      ->required();
  command->add_option("second", options.second, "Another one; not needed with --second-preset")
      ->type_name("SOURCE");
  command->add_option("--ssim", options.least_ssim, "Structural similarity that is needed, 0 to 1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--flip", options.most_flip,
                   "Mean difference that is seen (FLIP), at most, 0 to 1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--report", options.report,
                   "HTML file to write: images side by side, differences, figures")
      ->type_name("FILE");
  command
      ->add_option("--second-preset", options.second_preset,
                   "Preset of the denoiser on the second side")
      ->check(preset_name())
      ->group("Frames");
  command->add_option("--token", options.token, "Access token of the servers")
      ->envname("HELIOGRAPH_TOKEN")
      ->group("Servers");
  command
      ->add_option("--tls-ca", options.authorities,
                   "Certificates (PEM) to trust with https:// [the system's; any on loopback]")
      ->type_name("FILE")
      ->check(CLI::ExistingFile)
      ->group("Servers");
  add_view_options(*command, options.render);
  add_limit_options(*command, options.render.limits);
  add_device_options(*command, options.render.device);
  command->footer(compare_examples);
  return command;
}

}  // namespace heliograph::cli
