#include "cli/engine_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "protocol/settings/presets.hpp"
#include "protocol/settings/settings_json.hpp"
#include "render/api/buffer_names.hpp"
#include "render/api/device_lost.hpp"
#include "render/api/devices.hpp"

namespace heliograph::cli {
namespace {

constexpr int max_losses = 3;  // in a row

render::JpegEncoding jpeg_encoding(const std::string& name) {
  if (name == "on") return render::JpegEncoding::on;
  return name == "off" ? render::JpegEncoding::off : render::JpegEncoding::automatic;
}

render::CompressedTextures texture_compression(const std::string& name) {
  using render::CompressedTextures;
  if (name == "on") return CompressedTextures::on;
  return name == "off" ? CompressedTextures::off : CompressedTextures::automatic;
}

}  // namespace

std::filesystem::path cache_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  const std::filesystem::path cache = variable("XDG_CACHE_HOME");
  if (cache.is_absolute()) return cache / "heliograph";
  const std::filesystem::path home = variable("HOME");
  if (home.is_absolute()) return home / ".cache" / "heliograph";
  return {};
}

namespace {

std::unique_ptr<render::Engine> make_engine(const render::EngineOptions& options) {
  for (int losses = 1;; ++losses) {
    try {
      return std::make_unique<render::Engine>(options);
    } catch (const render::DeviceLost& failure) {
      if (losses == max_losses) {
        throw std::runtime_error("the graphics device was lost " + std::to_string(losses) +
                                 " times while it was set up: " + failure.what());
      }
      spdlog::warn("the device was lost while it was set up; trying again ({})", failure.what());
    }
  }
}

}  // namespace

render::EngineOptions engine_options(const DeviceOptions& options) {
  return {.device = fmt::format("{}", fmt::join(options.devices, ",")),
          .tracer = options.tracer,
          .validation = std::getenv("HELIOGRAPH_VALIDATION") != nullptr,
          .cache_folder = cache_folder(),
          .shader_folder = options.shader_dir,
          .jpeg = jpeg_encoding(options.gpu_jpeg),
          .compressed_textures = texture_compression(options.compressed_textures)};
}

std::vector<std::unique_ptr<render::Engine>> make_engines(const DeviceOptions& options) {
  std::vector<std::unique_ptr<render::Engine>> engines;
  for (const render::EngineOptions& one : render::choose_devices(engine_options(options))) {
    engines.push_back(make_engine(one));
  }
  return engines;
}

std::unique_ptr<render::Engine> make_engine(const DeviceOptions& options) {
  render::EngineOptions one = engine_options(options);
  const std::vector<std::string> names = render::device_names(one.device);
  one.device = names.empty() ? "" : names.front();
  return make_engine(render::choose_devices(one).front());
}

protocol::Settings parse_settings(const SettingsOptions& options) {
  protocol::Settings settings;
  if (!options.preset.empty()) {
    const protocol::Result<protocol::Preset> preset = protocol::find_preset(options.preset);
    if (!preset)
      throw std::invalid_argument("--preset " + options.preset + ": " + preset.error().message);
    const auto applied = protocol::apply_patch(settings, preset->settings.value());
    if (!applied)
      throw std::logic_error("preset " + options.preset + ": " + applied.error().message);
  }
  for (const std::string& assignment : options.assignments) {
    const protocol::Result<void> set = protocol::set_by_path(settings, assignment);
    if (!set) throw std::invalid_argument("--set " + assignment + ": " + set.error().message);
  }
  const auto named = render::check_buffer_name(settings.view.buffer, "view.buffer");
  if (!named) throw std::invalid_argument("--set " + named.error().message);
  return settings;
}

}  // namespace heliograph::cli
