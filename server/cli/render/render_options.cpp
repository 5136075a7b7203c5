#include <string>

#include "cli/option_groups.hpp"

namespace heliograph::cli {
namespace {

constexpr const char* render_examples = R"text(Examples:
  heliograph render helmet.glb -o helmet.png --width 1920 --height 1080
  heliograph render helmet.glb -o normals.png --buffer gbuffer.normals --samples 1
  heliograph render helmet.glb -o dark.png --environment studio.hdr --set exposure.compensation=-1
  heliograph render atrium.glb -o atrium.png --timings --frames 32
  heliograph render fox.glb -o run.mp4 --clip Run --frames 24
  heliograph render *.glb -o "{scene}/{camera}.png" --camera all --width 640
  heliograph render helmet.glb -o turn_%03d.png --turntable 36 --background transparent
  heliograph render helmet.glb -o turn.mp4 --turntable 72
  heliograph render helmet.glb -o front.png --orbit 0,20 --margin 0.1 --background blurred
  heliograph render helmet.glb -o red.png --edits helmet_edits.json
  heliograph render helmet.glb -o - > helmet.png
  heliograph render --manifest jobs.jsonl -o "out/{scene}.webp" --resume --report report.json
  heliograph render pillars.glb -o svgf.png --preset svgf --set accumulation.blend_samples=4096
  heliograph render pillars.glb -o reference.png --reference full --samples 1024

A manifest is a JSON array, or a JSON object on each line, of entries such as
  {"scene": "helmet.glb", "output": "helmet.png", "width": 512, "camera": "all"}
What an entry lacks is taken from the command line. server/README.md lists the members.)text";

void add_set_options(CLI::App& command, RenderOptions& options, CLI::Option* scenes) {
  constexpr const char* group = "Sets";
  command
      .add_option("--manifest", options.manifest,
                  "File with the entries to render, JSON or JSON Lines; \"-\" is standard input")
      ->type_name("FILE")
      ->excludes(scenes)
      ->group(group);
  command
      .add_option("--shard", options.shard,
                  "This process's share, such as 2/4: every fourth entry from the second on")
      ->type_name("I/N")
      ->group(group);
  command.add_flag("--resume", options.resume, "Keep files that exist, and render the others")
      ->group(group);
  command
      .add_option("--report", options.report,
                  "File to write at the end: what became of each entry, as JSON")
      ->type_name("FILE")
      ->group(group);
  command
      .add_option("--progress", options.progress,
                  "Progress on a terminal (stderr), or as JSON Lines (stdout) [terminal if stderr "
                  "is one; json with --manifest; else none]")
      ->check(one_of({"auto", "terminal", "json", "none"}))
      ->group(group);
}

void add_frame_options(CLI::App& command, protocol::RenderRequest& request) {
  auto* const turntable =
      command
          .add_option("--turntable", request.turntable,
                      "Number of frames of one turn of the camera around the scene")
          ->check(CLI::Range(1u, protocol::max_rendered_frames));
  command.add_option("--fps", request.fps, "Frames per second of the clip and of videos")
      ->check(CLI::Range(protocol::min_clip_rate, protocol::max_clip_rate))
      ->capture_default_str();
  command
      .add_option("--frames", request.frames,
                  "Number of frames of the clip, in numbered files or a video [1], or of frames "
                  "to measure for --timings [16]")
      ->check(CLI::Range(1u, protocol::max_rendered_frames))
      ->excludes(turntable);
}

void add_camera_options(CLI::App& command, RenderOptions& options) {
  protocol::RenderRequest& request = options.request;
  command
      .add_option("--camera", request.camera,
                  "Camera of the scene by its name or its number from 1 on, or \"all\" [the first; "
                  "without cameras the whole scene is in view]")
      ->type_name("NAME");
  command
      .add_option("--orbit", options.orbit,
                  "Camera that sees the whole scene from a direction, degrees: azimuth, 0 in "
                  "front and 90 on the right, and elevation, 90 above")
      ->type_name("AZIMUTH,ELEVATION");
  command
      .add_option("--path", options.path,
                  "JSON file of a camera that moves: {\"keys\": [{\"eye\": [x, y, z], \"target\": "
                  "[x, y, z]}, ...], \"seconds\": 6}")
      ->type_name("FILE");
  command.add_flag("--fit", request.fit,
                   "Keep the direction of the cameras, but move them so that they see the whole "
                   "scene");
  command
      .add_option("--margin", request.margin,
                  "Free part of the image on each side of a scene that is fitted into it [0.037]")
      ->check(CLI::Range(0.0, protocol::max_margin));
}

/// When an image is complete.
void add_quality_options(CLI::App& command, RenderOptions& options) {
  protocol::RenderRequest& request = options.request;
  command.add_option("--samples", request.samples, "Samples per pixel [accumulation.max_samples]")
      ->check(CLI::Range(1u, protocol::max_samples_per_pixel));
  command
      .add_option("--quality", request.quality,
                  "End an image when its expected structural similarity to the converged one is "
                  "this, such as 0.98")
      ->check(CLI::Range(protocol::min_similarity, protocol::max_similarity));
  command.add_option("--time-limit", request.time_limit, "End an image after so many seconds")
      ->check(CLI::Range(protocol::min_time_limit, protocol::max_time_limit));
  command
      .add_option("--reference", options.reference,
                  "Path trace instead: the hybrid's own light paths (same_paths) or all (full)")
      ->check(one_of({"same_paths", "full"}));
}

}  // namespace

void add_view_options(CLI::App& command, RenderOptions& options) {
  protocol::RenderRequest& request = options.request;
  add_size_options(command, request.width, request.height, "1280x720; one side gives the other");
  add_camera_options(command, options);
  add_quality_options(command, options);
  add_settings_options(command, options.settings);
  command
      .add_option("--background", request.background,
                  "sky, blurred, transparent (.png and .webp), or a colour such as #ffffff")
      ->capture_default_str();
  command.add_option("--variant", request.variant, "Material variant [the file's default]")
      ->type_name("NAME");
  add_environment_option(command, request.environment);
  auto* const clip = command.add_option("--clip", request.clip,
                                        "Animation clip that poses the scene [default pose]");
  clip->type_name("NAME");
  command.add_option("--time", request.time, "Time in the clip, seconds")
      ->check(CLI::Range(0.0, protocol::max_clip_time))
      ->needs(clip)
      ->capture_default_str();
}

CLI::App* add_render(CLI::App& app, RenderOptions& options) {
  protocol::RenderRequest& request = options.request;
  CLI::App* command = app.add_subcommand("render", "Render images and videos of scenes into files");
  auto* const scenes =
      command->add_option("scene", options.scenes, "One or more .glb or .gltf files");
  scenes->type_name("FILE");
  command
      ->add_option("-o,--output", request.output,
                   "File to write: .png, .jpg or .webp; .exr or .npy for values; .mp4 or .webm for "
                   "frames. {scene}, {camera} and {frame:04} (or %04d) in the name stand for what "
                   "is in the image; \"-\" is standard output")
      ->type_name("FILE");
  command
      ->add_option("--format", options.format,
                   "Format of the files [by their extension; png for -]")
      ->check(one_of({"png", "jpg", "webp", "exr", "npy", "mp4", "webm", "animated_webp"}));
  add_view_options(*command, options);
  command
      ->add_option(
          "--edits", options.edits,
          "Changes of lights, materials, textures, visibility and environment to apply: the file "
          "that the page saves, or the document of edits.get")
      ->type_name("FILE");
  add_images_option(*command, options.images);
  command->add_option("--buffer", request.buffer, "Buffer to write")->capture_default_str();
  add_limit_options(*command, options.limits);
  command->add_flag("--timings", options.timings,
                    "Print one line of JSON: the median time of each pass");
  add_frame_options(*command, request);
  add_set_options(*command, options, scenes);
  add_device_options(*command, options.device);
  add_shader_option(*command, options.device);
  command->footer(render_examples);
  return command;
}

}  // namespace heliograph::cli
