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
      double sum = 0.0;
      int seeds = 0;
      for (const Measurement& m : rows) {
        if (m.technique != name || m.value != value) continue;
        sum += m.quality.*column.member;
        ++seeds;
      }
      text += padded(seeds > 0 ? number(sum / seeds, column.decimals) : "-", 9);
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
          {"value", timing.value ? nlohmann::json(*timing.value) : nlohmann::json()},
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
          {"seed", m.seed},
          {"ssim", m.quality.ssim},
          {"flicker", m.quality.flicker},
          {"luminance_ratio", m.quality.luminance_ratio}};
}

std::string quality_csv(const Results& results) {
  std::ostringstream text;
  text << "scene,swept,value,movement,preset,seed,ssim,flicker,luminance_ratio\n";
  for (const Measurement& m : results.measurements) {
    text << m.scene << ',' << name(m.swept) << ',' << m.value << ',' << name(m.movement) << ','
         << m.technique << ',' << m.seed << ',' << m.quality.ssim << ',' << m.quality.flicker << ','
         << m.quality.luminance_ratio << '\n';
  }
  return text.str();
}

/// Empty where a scene has its own materials and sun.
std::string text_of(std::optional<float> value) {
  std::ostringstream text;
  if (value) text << *value;
  return text.str();
}

std::string timings_csv(const Results& results) {
  std::ostringstream text;
  text << "scene,value,movement,preset,min_fps,avg_fps,max_fps\n";
  for (const Timing& timing : results.timings) {
    text << timing.scene << ',' << text_of(timing.value) << ',' << name(timing.movement) << ','
         << timing.technique << ',' << timing.slowest_fps << ',' << timing.mean_fps << ','
         << timing.fastest_fps << '\n';
  }
  return text.str();
}

std::string passes_csv(const Results& results) {
  std::ostringstream text;
  text << "scene,value,movement,preset,pass,ms\n";
  for (const Timing& timing : results.timings) {
    for (const render::PassTime& pass : timing.passes) {
      text << timing.scene << ',' << text_of(timing.value) << ',' << name(timing.movement) << ','
           << timing.technique << ',' << pass.name << ',' << pass.milliseconds << '\n';
    }
  }
  return text.str();
}

std::string moments_csv(const Results& results) {
  std::ostringstream text;
  text << "scene,value,preset,frame,ssim\n";
  for (const Moment& moment : results.moments) {
    text << moment.scene << ',' << text_of(moment.value) << ',' << moment.technique << ','
         << moment.frame << ',' << moment.ssim << '\n';
  }
  return text.str();
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace

std::string image_name(const Measurement& m) {
  return m.scene + "_" + std::to_string(int(100.0f * m.value)) + "_" +
         std::string(name(m.movement)) + "_";
}

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

void write_files(const std::filesystem::path& folder, const Results& results,
                 const nlohmann::json& run) {
  std::filesystem::create_directories(folder);
  nlohmann::json document = {
      {"run", run}, {"quality", nlohmann::json::array()}, {"timings", nlohmann::json::array()}};
  for (const Measurement& m : results.measurements) document["quality"].push_back(to_json(m));
  for (const Timing& timing : results.timings) document["timings"].push_back(to_json(timing));
  if (!results.measurements.empty()) write(folder / "quality.csv", quality_csv(results));
  if (!results.timings.empty()) {
    write(folder / "timings.csv", timings_csv(results));
    write(folder / "passes.csv", passes_csv(results));
  }
  if (!results.moments.empty()) write(folder / "over_time.csv", moments_csv(results));
  write(folder / "experiments.json", document.dump(1));
}

}  // namespace heliograph::paper
