#include "scenes/generator/atrium.hpp"
#include "scenes/generator/environment.hpp"
#include "scenes/generator/glb.hpp"
#include "scenes/generator/test_scenes.hpp"

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

namespace {

using namespace heliograph::scenes;

constexpr const char* usage =
    "usage: heliograph-scenes OUTPUT_DIR [--only NAME]... [--texture-size PIXELS]\n"
    "names: atrium, sky, tests (written when none is named), atrium_2, atrium_3\n";

struct Target {
  std::string_view name;
  bool by_default;
};
constexpr std::array<Target, 5> targets = {
    {{"atrium", true}, {"sky", true}, {"tests", true}, {"atrium_2", false}, {"atrium_3", false}}};

struct Options {
  std::filesystem::path output;
  std::vector<std::string_view> only;
  int texture_size = 512;
  bool help = false;

  bool wants(std::string_view name) const {
    if (!only.empty()) return std::find(only.begin(), only.end(), name) != only.end();
    return std::any_of(targets.begin(), targets.end(), [&](const Target& target) {
      return target.name == name && target.by_default;
    });
  }
};

std::string_view parse_name(std::string_view name) {
  for (const Target& target : targets) {
    if (target.name == name) return target.name;
  }
  throw std::invalid_argument("no scene is called " + std::string(name));
}

int parse_texture_size(std::string_view text) {
  constexpr int smallest = 16;
  constexpr int largest = 4096;
  int size = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, size);
  if (parsed.ec != std::errc() || parsed.ptr != end || size < smallest || size > largest) {
    throw std::invalid_argument("--texture-size must be a whole number from 16 to 4096");
  }
  return size;
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
      options.texture_size = parse_texture_size(value());
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
  // Under another name first: who reads the old file meanwhile never sees half of the new one.
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
  const bool only_tests = options.only == std::vector<std::string_view>{"tests"};
  if (only_tests) return;
  const ClearSky sky = make_clear_sky(direction_to_sun(sun_elevation, sun_azimuth), 1024, 512);
  if (options.wants("sky")) {
    write_file(options.output / "sky.hdr", encode_hdr(sky.environment), "clear sky");
  }
  if (options.wants("atrium")) write_document(options, make_atrium(1, sky));
  if (options.wants("atrium_2")) write_document(options, make_atrium(2, sky));
  if (options.wants("atrium_3")) write_document(options, make_atrium(3, sky));
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
