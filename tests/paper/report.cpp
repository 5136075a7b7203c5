#include "tests/paper/report.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace heliograph::paper {
namespace {

std::string padded(const std::string& text, int width) {
  return text + std::string(std::max(0, width - int(text.size())), ' ');
}

std::string number(double value, int decimals) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

/// Distinct keys in order of first appearance.
template <class Item, class Key>
std::vector<Key> distinct(const std::vector<Item>& items,
                          const std::function<Key(const Item&)>& of) {
  std::vector<Key> keys;
  for (const Item& item : items) {
    const Key key = of(item);
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  return keys;
}

struct Column {
  const char* title;
  double Quality::*member;
  int decimals;
};
constexpr Column columns[] = {{"SSIM", &Quality::ssim, 4},
                              {"flicker", &Quality::flicker, 2},
                              {"luminance / ground truth", &Quality::luminance_ratio, 3}};

std::string table(const std::vector<Measurement>& rows, const Column& column) {
  const auto values = distinct<Measurement, float>(rows, [](const auto& m) { return m.value; });
  const auto names =
      distinct<Measurement, std::string>(rows, [](const auto& m) { return m.technique; });
  std::string text = padded(column.title, 20);
  for (const float value : values) text += padded(number(value, 1), 9);
  text += "\n";
  for (const std::string& name : names) {
    text += padded("  " + name, 20);
    for (const float value : values) {
      const auto found = std::find_if(rows.begin(), rows.end(), [&](const Measurement& m) {
        return m.technique == name && m.value == value;
      });
      const bool measured = found != rows.end();
      text += padded(measured ? number(found->quality.*column.member, column.decimals) : "-", 9);
    }
    text += "\n";
  }
  return text;
}

nlohmann::json to_json(const Timing& timing) {
  nlohmann::json passes = nlohmann::json::array();
  for (const render::PassTime& pass : timing.passes) {
    passes.push_back(
        {{"name", pass.name}, {"kind", protocol::enum_name(pass.kind)}, {"ms", pass.milliseconds}});
  }
  return {{"scene", timing.scene},
          {"preset", timing.technique},
          {"movement", name(timing.movement)},
          {"min_fps", timing.slowest_fps},
          {"avg_fps", timing.mean_fps},
          {"max_fps", timing.fastest_fps},
          {"passes", passes}};
}

nlohmann::json to_json(const Measurement& m) {
  return {{"scene", m.scene},
          {"swept", name(m.swept)},
          {"value", m.value},
          {"movement", name(m.movement)},
          {"preset", m.technique},
          {"ssim", m.quality.ssim},
          {"flicker", m.quality.flicker},
          {"luminance_ratio", m.quality.luminance_ratio}};
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace

Timing summarise(const std::vector<render::Frame>& frames, int warm_up) {
  if (frames.size() <= std::size_t(warm_up)) {
    throw std::invalid_argument("more frames than the " + std::to_string(warm_up) +
                                " that warm up are needed for times");
  }
  Timing timing;
  double milliseconds = 0.0;
  timing.fastest_fps = 0.0;
  timing.slowest_fps = 1e30;
  const double count = double(frames.size() - std::size_t(warm_up));
  for (std::size_t i = std::size_t(warm_up); i < frames.size(); ++i) {
    const double fps = 1000.0 / std::max(1e-3, double(frames[i].milliseconds));
    milliseconds += double(frames[i].milliseconds);
    timing.slowest_fps = std::min(timing.slowest_fps, fps);
    timing.fastest_fps = std::max(timing.fastest_fps, fps);
    for (const render::PassTime& pass : frames[i].passes) {
      auto known = std::find_if(timing.passes.begin(), timing.passes.end(),
                                [&](const auto& p) { return p.name == pass.name; });
      if (known == timing.passes.end()) {
        known = timing.passes.insert(timing.passes.end(), {pass.name, pass.kind, 0.0f});
      }
      known->milliseconds += float(double(pass.milliseconds) / count);
    }
  }
  timing.mean_fps = 1000.0 * count / milliseconds;
  return timing;
}

std::string quality_tables(const std::vector<Measurement>& measurements) {
  std::string text;
  const auto heading = [](const Measurement& m) {
    return m.scene + ", " + std::string(name(m.movement)) + ", by " + std::string(name(m.swept));
  };
  for (const std::string& title : distinct<Measurement, std::string>(measurements, heading)) {
    std::vector<Measurement> rows;
    for (const Measurement& m : measurements) {
      if (heading(m) == title) rows.push_back(m);
    }
    text += "\n" + title + "\n";
    for (const Column& column : columns) text += table(rows, column);
  }
  return text;
}

std::string timing_tables(const std::vector<Timing>& timings) {
  std::string text =
      "\nframes per second\n" + padded("", 46) + padded("min", 9) + padded("avg", 9) + "max\n";
  for (const Timing& timing : timings) {
    text += padded("  " + timing.scene + ", " + std::string(name(timing.movement)) + ", " +
                       timing.technique,
                   46) +
            padded(number(timing.slowest_fps, 1), 9) + padded(number(timing.mean_fps, 1), 9) +
            number(timing.fastest_fps, 1) + "\n";
  }
  for (const Timing& timing : timings) {
    text += "\n" + timing.scene + ", " + std::string(name(timing.movement)) + ", " +
            timing.technique + ": milliseconds\n";
    for (const render::PassTime& pass : timing.passes) {
      text += padded("  " + pass.name, 46) + number(double(pass.milliseconds), 3) + "\n";
    }
  }
  return text;
}

void write_files(const std::filesystem::path& folder, const std::vector<Measurement>& measurements,
                 const std::vector<Timing>& timings, const std::string& device) {
  std::filesystem::create_directories(folder);
  std::ostringstream quality;
  quality << "scene,swept,value,movement,preset,ssim,flicker,luminance_ratio\n";
  nlohmann::json document = {{"device", device},
                             {"quality", nlohmann::json::array()},
                             {"timings", nlohmann::json::array()}};
  for (const Measurement& m : measurements) {
    quality << m.scene << ',' << name(m.swept) << ',' << m.value << ',' << name(m.movement) << ','
            << m.technique << ',' << m.quality.ssim << ',' << m.quality.flicker << ','
            << m.quality.luminance_ratio << '\n';
    document["quality"].push_back(to_json(m));
  }
  std::ostringstream times;
  times << "scene,movement,preset,min_fps,avg_fps,max_fps\n";
  for (const Timing& timing : timings) {
    times << timing.scene << ',' << name(timing.movement) << ',' << timing.technique << ','
          << timing.slowest_fps << ',' << timing.mean_fps << ',' << timing.fastest_fps << '\n';
    document["timings"].push_back(to_json(timing));
  }
  write(folder / "quality.csv", quality.str());
  write(folder / "timings.csv", times.str());
  write(folder / "experiments.json", document.dump(1));
}

}  // namespace heliograph::paper
