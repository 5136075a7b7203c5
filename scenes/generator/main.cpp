#include <charconv>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/generator/atrium.hpp"
#include "scenes/generator/environment.hpp"
#include "scenes/generator/glb.hpp"
#include "scenes/generator/test_scenes.hpp"

namespace {

using namespace heliograph::scenes;

constexpr const char* usage =
    "usage: heliograph-scenes OUTPUT_DIR [--only NAME]... [--texture-size PIXELS]\n"
    "names: atrium (written unless others are named), atrium_2, atrium_3, sky, tests\n";

struct Options {
  std::filesystem::path output;
  std::vector<std::string> only;
  int texture_size = 512;

  bool wants(std::string_view name, bool by_default = true) const {
    if (only.empty()) return by_default;
    for (const std::string& wanted : only) {
      if (wanted == name) return true;
    }
    return false;
  }
};

Options parse(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    const bool takes_value = argument == "--only" || argument == "--texture-size";
    if (takes_value && i + 1 == count) throw std::invalid_argument(argument + " needs a value");
    if (argument == "--only") {
      const std::string name = arguments[++i];
      static constexpr std::string_view known[] = {"atrium", "atrium_2", "atrium_3", "sky",
                                                   "tests"};
      bool found = false;
      for (const std::string_view candidate : known) found |= candidate == name;
      if (!found) throw std::invalid_argument("no scene is called " + name);
      options.only.push_back(name);
    } else if (argument == "--texture-size") {
      const std::string_view value = arguments[++i];
      const auto end = value.data() + value.size();
      const auto parsed = std::from_chars(value.data(), end, options.texture_size);
      if (parsed.ec != std::errc() || parsed.ptr != end || options.texture_size < 16 ||
          options.texture_size > 4096) {
        throw std::invalid_argument("--texture-size must be a whole number from 16 to 4096");
      }
    } else if (argument.starts_with("-") || !options.output.empty()) {
      throw std::invalid_argument("unexpected argument " + argument);
    } else {
      options.output = argument;
    }
  }
  if (options.output.empty()) throw std::invalid_argument("no output directory given");
  return options;
}

void write_file(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes,
                const std::string& what) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
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
  std::filesystem::create_directories(options.output);
  if (options.wants("tests")) {
    write_file(options.output / "white.hdr", encode_hdr(make_white_environment()), "radiance 1");
    write_document(options, make_furnace());
    write_document(options, make_mirror());
  }
  const ClearSky sky = make_clear_sky(direction_to_sun(sun_elevation, sun_azimuth), 1024, 512);
  if (options.wants("sky")) {
    write_file(options.output / "sky.hdr", encode_hdr(sky.environment), "clear sky");
  }
  if (options.wants("atrium")) write_document(options, make_atrium(1, sky));
  if (options.wants("atrium_2", false)) write_document(options, make_atrium(2, sky));
  if (options.wants("atrium_3", false)) write_document(options, make_atrium(3, sky));
}

}  // namespace

int main(int count, char** arguments) {
  Options options;
  try {
    options = parse(count, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heliograph-scenes: %s\n%s", error.what(), usage);
    return 2;
  }
  try {
    generate(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heliograph-scenes: %s\n", error.what());
    return 1;
  }
  return 0;
}
