#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/compare/comparison_report.hpp"
#include "cli/compare/image_source.hpp"
#include "cli/render/output/output_file.hpp"

namespace heliograph::cli {
namespace {

constexpr int exit_similar = 0;
constexpr int exit_differs = 1;
constexpr int exit_failed = 2;  // as of wrong options

Comparison compared_images(const CompareOptions& options, const std::string& name,
                           ComparedImage first, ComparedImage second) {
  if (first.width != second.width || first.height != second.height) {
    throw std::runtime_error(name + ": the images have different sizes, " +
                             std::to_string(first.width) + "x" + std::to_string(first.height) +
                             " and " + std::to_string(second.width) + "x" +
                             std::to_string(second.height));
  }
  Comparison result{.name = name, .first = std::move(first), .second = std::move(second)};
  result.similarity = structural_similarity(result.first, result.second);
  result.differences = flip(result.first, result.second);
  for (const float value : result.differences) result.flip += static_cast<double>(value);
  result.flip /= static_cast<double>(result.differences.size());
  for (std::size_t i = 0; i < result.first.rgba.size(); ++i) {
    const int difference = std::abs(result.first.rgba[i] - result.second.rgba[i]);
    if (i % 4 != 3)
      result.largest = std::max(result.largest, static_cast<std::uint8_t>(difference));
  }
  result.accepted = result.similarity >= options.least_ssim && result.flip <= options.most_flip;
  return result;
}

/// Images of one name; where both sides have one only, these, whatever their names.
std::vector<Comparison> compare_sides(const CompareOptions& options, NamedImages first,
                                      NamedImages second) {
  std::vector<Comparison> comparisons;
  if (first.size() == 1 && second.size() == 1) {
    comparisons.push_back(compared_images(options, first.begin()->first,
                                          std::move(first.begin()->second),
                                          std::move(second.begin()->second)));
    return comparisons;
  }
  for (auto& [name, image] : first) {
    const auto other = second.find(name);
    if (other == second.end()) {
      throw std::runtime_error(options.second + " has no camera " + name);
    }
    comparisons.push_back(
        compared_images(options, name, std::move(image), std::move(other->second)));
  }
  if (second.size() != first.size()) {
    throw std::runtime_error(options.second + " has cameras that " + options.first + " lacks");
  }
  return comparisons;
}

int compare(const CompareOptions& options) {
  const bool presets = options.second.empty();
  if (presets && options.second_preset.empty()) {
    throw std::runtime_error(
        "compare: a second scene, server or image is missing, or "
        "--second-preset");
  }
  if (!options.report.empty() && !can_write(options.report)) {
    throw std::runtime_error("--report: cannot write " + options.report);
  }
  RenderOptions other = options.render;
  if (!options.second_preset.empty()) other.settings.preset = options.second_preset;
  const std::string& second = presets ? options.first : options.second;
  const std::vector<Comparison> comparisons =
      compare_sides(options, images_of(options.first, options.render, options),
                    images_of(second, other, options));
  for (const Comparison& one : comparisons) {
    std::printf("%s: SSIM %.4f, FLIP %.4f, largest difference %d: %s\n", one.name.c_str(),
                one.similarity, one.flip, one.largest, one.accepted ? "similar" : "differs");
  }
  if (!options.report.empty()) {
    const std::string page = comparison_page(
        presets ? options.first + " " + options.render.settings.preset : options.first,
        presets ? second + " " + options.second_preset : second, comparisons);
    write_whole(options.report, {page.begin(), page.end()});
  }
  return std::ranges::all_of(comparisons, &Comparison::accepted) ? exit_similar : exit_differs;
}

}  // namespace

int run(const CompareOptions& options) {
  try {
    return compare(options);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph: %s\n", failure.what());
    return exit_failed;
  }
}

}  // namespace heliograph::cli
