#include "cli/compare/comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "stream/encoders/base64.hpp"
#include "stream/encoders/png_encoder.hpp"

namespace heliograph::cli {
namespace {

constexpr const char* page_head = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="dark light">
<title>Comparison · Heliograph</title>
<style>
body { margin: 24px; font: 14px/1.45 system-ui, sans-serif; }
table { border-collapse: collapse; }
th, td { padding: 4px 14px 4px 0; text-align: left; }
.images { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 12px; }
.images img { width: 100%; image-rendering: pixelated; }
figure { margin: 0; }
.differs { color: #d33; font-weight: 600; }
@media (max-width: 700px) { .images { grid-template-columns: 1fr; } }
</style>
</head>
<body>
)html";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<') {
      result += "&lt;";
    } else if (c == '&') {
      result += "&amp;";
    } else if (c == '"') {
      result += "&quot;";
    } else {
      result += c;
    }
  }
  return result;
}

/// From black over violet, red and yellow to white: the order of the lightness is that of the
/// value.
std::array<std::uint8_t, 3> heat(float value) {
  constexpr std::array<std::array<float, 3>, 5> stops{
      {{0, 0, 0}, {80, 18, 123}, {183, 55, 121}, {252, 137, 97}, {252, 253, 191}}};
  const float at = std::clamp(value, 0.0f, 1.0f) * (stops.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  std::array<std::uint8_t, 3> color{};
  for (std::size_t i = 0; i < 3; ++i) {
    color[i] = static_cast<std::uint8_t>(
        std::lround(std::lerp(stops[low][i], stops[low + 1][i], at - static_cast<float>(low))));
  }
  return color;
}

ComparedImage heat_map(const Comparison& comparison) {
  ComparedImage image{comparison.first.width, comparison.first.height, {}};
  for (const float value : comparison.differences) {
    const auto color = heat(value);
    image.rgba.insert(image.rgba.end(), {color[0], color[1], color[2], 255});
  }
  return image;
}

std::string figure(const ComparedImage& image, const std::string& caption) {
  const auto png =
      stream::encode_png({.width = image.width, .height = image.height, .rgba = image.rgba});
  return fmt::format(
      "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption>"
      "</figure>\n",
      escaped(caption), stream::base64_encode(png));
}

std::string table(const std::vector<Comparison>& comparisons) {
  std::string text =
      "<table><thead><tr><th>image</th><th>SSIM</th><th>FLIP</th><th>largest difference</th>"
      "<th></th></tr></thead><tbody>\n";
  for (const Comparison& one : comparisons) {
    text += fmt::format(
        "<tr><th>{}</th><td>{:.4f}</td><td>{:.4f}</td><td>{} of 255</td><td{}</td></tr>\n",
        escaped(one.name), one.similarity, one.flip, one.largest,
        one.accepted ? ">similar" : " class=\"differs\">differs");
  }
  return text + "</tbody></table>\n";
}

}  // namespace

std::string comparison_page(const std::string& first, const std::string& second,
                            const std::vector<Comparison>& comparisons) {
  std::string page = page_head;
  page += fmt::format("<h1>{} and {}</h1>\n", escaped(first), escaped(second));
  page += table(comparisons);
  for (const Comparison& one : comparisons) {
    page += fmt::format("<h2>{}</h2>\n<div class=\"images\">\n", escaped(one.name));
    page += figure(one.first, first) + figure(one.second, second);
    page += figure(heat_map(one), "Differences that are seen (FLIP)") + "</div>\n";
  }
  return page + "</body>\n</html>\n";
}

}  // namespace heliograph::cli
