#include "cli/option_groups.hpp"

namespace heliograph::cli {
namespace {

constexpr const char* export_examples = R"text(Examples:
  heliograph export helmet.gltf -o helmet.glb                 one file with all that it refers to
  heliograph export room.glb --edits room_edits.json -o evening.glb

Needs no device. What glTF cannot say is told as a warning.)text";

}  // namespace

CLI::App* add_export(CLI::App& app, ExportOptions& options) {
  CLI::App* command =
      app.add_subcommand("export", "Write a scene with its edits as a new .glb file");
  command->add_option("scene", options.scene, "A .glb or .gltf file")
      ->type_name("FILE")
      ->required();
  command
      ->add_option(
          "--edits", options.edits,
          "File with changes of lights, materials, textures and visibility: the one that the page "
          "saves, or the document of edits.get")
      ->type_name("FILE");
  add_images_option(*command, options.images);
  command
      ->add_option("--variant", options.variant,
                   "Material variant that becomes the default [the file's]")
      ->type_name("NAME");
  command->add_option("-o,--output", options.output, "File to write, which ends in .glb")
      ->type_name("FILE")
      ->required();
  add_limit_options(*command, options.limits);
  command->footer(export_examples);
  return command;
}

}  // namespace heliograph::cli
