#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "scenes/generator/gltf/glb.hpp"
#include "scenes/generator/scenes/material_balls.hpp"
#include "scenes/generator/scenes/paper_scenes.hpp"
#include "scenes/generator/scenes/test_scenes.hpp"
#include "scenes/generator/sky/environment.hpp"
#include "scenes/generator/sky/studio.hpp"

namespace {

using namespace heliograph::scenes;

constexpr const char* usage =
    "usage: heliograph-scenes OUTPUT_DIR [--only NAME]... [--texture-size PIXELS]\n"
    "                         [--roughness R] [--shadow-angle DEGREES]\n"
    "names: cubes_distance, icosphere, glossy_sponza_1, glossy_sponza_2, glossy_sponza_3,\n"
    "       shadow_objects, pillars, breakfast_room (each with its sky), sky, studio, tests,\n"
    "       material_balls; without any, all but glossy_sponza_2, glossy_sponza_3 and\n"
    "       material_balls\n"
    "--roughness gives the swept materials this roughness all over, --shadow-angle the sun this\n"
    "angular diameter.\n";

constexpr int sky_width = 1024;
constexpr int sky_height = 512;

struct Options {
  std::filesystem::path output;
  std::vector<std::string_view> only;
  int texture_size = 512;
  Sweep sweep;
  bool help = false;

  bool wants(std::string_view name) const {
    if (!only.empty()) return std::find(only.begin(), only.end(), name) != only.end();
    return name != "glossy_sponza_2" && name != "glossy_sponza_3" && name != "material_balls";
  }
};

std::string_view parse_name(std::string_view name) {
  constexpr std::array<std::string_view, 4> others = {"sky", "studio", "tests", "material_balls"};
  if (std::ranges::find(others, name) == others.end()) find_paper_scene(name);
  return name;
}

template <class Number>
Number parse_number(std::string_view option, std::string_view text, Number low, Number high) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end || !(value >= low && value <= high)) {
    const auto shown = [](Number limit) {
      std::array<char, 32> digits{};
      return std::string(digits.data(),
                         std::to_chars(digits.data(), digits.data() + digits.size(), limit).ptr);
    };
    throw std::invalid_argument(std::string(option) + " must be a number from " + shown(low) +
                                " to " + shown(high));
  }
  return value;
}

Options parse(const std::vector<std::string_view>& arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view argument = arguments[i];
    const auto value = [&] {
      if (i + 1 == arguments.size()) {
        throw std::invalid_argument(std::string(argument) + " needs a value");
      }
      return arguments[++i];
    };
    if (argument == "--help") {
      options.help = true;
    } else if (argument == "--only") {
      options.only.push_back(parse_name(value()));
    } else if (argument == "--texture-size") {
      options.texture_size = parse_number(argument, value(), 16, 4096);
    } else if (argument == "--roughness") {
      options.sweep.roughness = parse_number(argument, value(), 0.0f, 1.0f);
    } else if (argument == "--shadow-angle") {
      options.sweep.shadow_angle = parse_number(argument, value(), 0.0f, 90.0f);
    } else if (argument.starts_with("-") || !options.output.empty()) {
      throw std::invalid_argument("unexpected argument " + std::string(argument));
    } else {
      options.output = argument;
    }
  }
  if (options.output.empty() && !options.help) {
    throw std::invalid_argument("no output directory given");
  }
  return options;
}

void write_file(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes,
                const std::string& what) {
  // Written under another name first, so that readers never see a partial file.
  std::filesystem::path partial = path;
  partial += ".partial";
  std::ofstream file(partial, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error("cannot write " + partial.string());
  std::filesystem::rename(partial, path);
  std::printf("%-24s %9zu bytes  %s\n", path.filename().c_str(), bytes.size(), what.c_str());
  std::fflush(stdout);
}

void write_document(const Options& options, const Document& document) {
  write_file(options.output / (document.name + ".glb"), encode_glb(document, options.texture_size),
             std::to_string(document.drawn_triangles()) + " triangles, " +
                 std::to_string(document.instance_count()) + " instances, " +
                 std::to_string(document.materials.size()) + " materials");
}

// With a sky file of the same name beside it, which the server loads by default.
void write_scene(const Options& options, const PaperScene& scene) {
  const ClearSky sky = scene.make_sky(sky_width, sky_height);
  write_file(options.output / (std::string(scene.name) + ".hdr"), encode_hdr(sky.environment),
             "clear sky");
  Document document = scene.make_document(sky);
  apply(options.sweep, document);
  write_document(options, document);
}

void generate(const Options& options) {
  std::error_code failure;
  std::filesystem::create_directories(options.output, failure);
  if (failure) {
    throw std::runtime_error("cannot create the directory " + options.output.string() + ": " +
                             failure.message());
  }
  if (options.wants("tests")) {
    write_file(options.output / "white.hdr", encode_hdr(make_white_environment()), "radiance 1");
    write_document(options, make_furnace());
    write_document(options, make_mirror());
  }
  if (options.wants("material_balls")) {
    write_file(options.output / "material_balls.hdr", encode_hdr(make_material_balls_environment()),
               "softboxes");
    write_document(options, make_material_balls());
  }
  if (options.wants("sky")) {
    const ClearSky sky = find_paper_scene("glossy_sponza_1").make_sky(sky_width, sky_height);
    write_file(options.output / "sky.hdr", encode_hdr(sky.environment), "clear sky");
  }
  if (options.wants("studio")) {
    write_file(options.output / "studio.hdr", encode_hdr(make_studio(sky_width, sky_height)),
               "softboxes");
  }
  for (const PaperScene& scene : paper_scenes()) {
    if (options.wants(scene.name)) write_scene(options, scene);
  }
}

}  // namespace

int main(int count, char** arguments) {
  try {
    const Options options = parse({arguments + 1, arguments + count});
    if (options.help) {
      std::fputs(usage, stdout);
      return 0;
    }
    generate(options);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "heliograph-scenes: %s (see --help)\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heliograph-scenes: %s\n", error.what());
    return 1;
  }
  return 0;
}
