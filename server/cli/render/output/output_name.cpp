#include "cli/render/output/output_name.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

#include "protocol/json/suggestions.hpp"

namespace heliograph::cli {
namespace {

constexpr std::size_t max_digits = 9;
constexpr std::size_t default_digits = 4;

/// "04" or "4"; nothing else than a number of digits.
std::size_t digits_of(std::string_view format) {
  std::size_t digits = 0;
  const char* const end = format.data() + format.size();
  const auto parsed = std::from_chars(format.data(), end, digits);
  const bool valid = parsed.ec == std::errc() && parsed.ptr == end && digits <= max_digits;
  if (!valid) {
    throw std::invalid_argument("--output: {frame:" + std::string(format) +
                                "} must have a number of digits, such as {frame:04}");
  }
  return digits;
}

std::string path_element(std::string name) {
  for (char& c : name) {
    if (c == '/' || static_cast<unsigned char>(c) < ' ') c = '_';
  }
  return name;
}

/// Folders named by what is in the image do not lead out of theirs.
std::filesystem::path contained(const std::string& name) {
  std::filesystem::path path;
  for (const std::filesystem::path& element : std::filesystem::path(name)) {
    path /= element == ".." ? std::filesystem::path("_") : element;
  }
  return path;
}

std::string padded(std::uint32_t number, std::size_t digits) {
  std::string text = std::to_string(number);
  text.insert(0, digits - std::min(text.size(), digits), '0');
  return text;
}

}  // namespace

OutputName::OutputName(const std::string& text) {
  if (text == "-") return;
  const std::size_t placeholder = std::min(text.find('{'), text.size());
  const std::size_t slash = text.rfind('/', placeholder);
  const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
  folder_ = begin == 0 ? "." : text.substr(0, begin);
  std::string_view name = std::string_view(text).substr(begin);
  std::error_code ignored;
  if (name.empty() || name.back() == '/' || std::filesystem::is_directory(text, ignored)) {
    throw std::invalid_argument("--output: " + text +
                                " is a folder; name the files in it, such as {scene}.png");
  }
  while (!name.empty()) {
    const std::string_view pair = name.substr(0, 2);
    std::size_t length = 1;
    if (pair == "{{" || pair == "}}" || pair == "%%") {
      add_text(pair.substr(0, 1));
      length = 2;
    } else if (name[0] == '{') {
      const std::size_t end = name.find('}');
      if (end == std::string_view::npos) {
        throw std::invalid_argument("--output: a placeholder has no }; {{ is a brace");
      }
      add_placeholder(name.substr(1, end - 1));
      length = end + 1;
    } else if (const std::size_t printf = name[0] == '%' ? add_printf(name) : 0; printf > 0) {
      length = printf;
    } else {
      add_text(name.substr(0, 1));
    }
    name.remove_prefix(length);
  }
}

bool OutputName::has(Kind kind) const {
  return std::ranges::any_of(parts_, [&](const Part& part) { return part.kind == kind; });
}

void OutputName::add_text(std::string_view text) {
  if (parts_.empty() || parts_.back().kind != Kind::text) parts_.emplace_back();
  parts_.back().text += text;
}

void OutputName::add_placeholder(std::string_view name) {
  constexpr std::string_view frame_format = "frame:";
  if (name == "scene") return parts_.push_back({.kind = Kind::scene, .text = {}});
  if (name == "camera") return parts_.push_back({.kind = Kind::camera, .text = {}});
  if (name == "frame") {
    return parts_.push_back({.kind = Kind::frame, .text = {}, .digits = default_digits});
  }
  if (name.starts_with(frame_format)) {
    const std::size_t digits = digits_of(name.substr(frame_format.size()));
    return parts_.push_back({.kind = Kind::frame, .text = {}, .digits = digits});
  }
  throw std::invalid_argument("--output: {" + std::string(name) + "} is not a placeholder" +
                              protocol::suggestion(name, {"scene", "camera", "frame"}) +
                              " (scene, camera, frame or frame:04)");
}

std::size_t OutputName::add_printf(std::string_view text) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789", 1), text.size());
  if (end == text.size() || std::string_view("diu").find(text[end]) == std::string_view::npos) {
    return 0;
  }
  const std::size_t digits = end == 1 ? 0 : digits_of(text.substr(1, end - 1));
  parts_.push_back({.kind = Kind::frame, .text = {}, .digits = digits});
  return end + 1;
}

void OutputName::add_frame() {
  const std::string ending = extension();
  Part& last = parts_.back();
  if (last.kind == Kind::text) last.text.resize(last.text.size() - ending.size());
  add_text("_");
  add_placeholder("frame");
  add_text(ending);
}

std::string OutputName::extension() const {
  if (parts_.empty() || parts_.back().kind != Kind::text) return {};
  const std::string& last = parts_.back().text;
  const std::size_t dot = last.rfind('.');
  if (dot != std::string::npos && last.find('/', dot) != std::string::npos) return {};
  // ".png" is a name
  const bool hidden =
      dot == 0 ? parts_.size() == 1 : dot != std::string::npos && last[dot - 1] == '/';
  return dot == std::string::npos || hidden ? std::string() : last.substr(dot);
}

std::filesystem::path OutputName::file(const ImageOf& image) const {
  std::string name;
  for (const Part& part : parts_) {
    switch (part.kind) {
      case Kind::text:
        name += part.text;
        break;
      case Kind::scene:
        name += path_element(image.scene);
        break;
      case Kind::camera:
        name += path_element(image.camera);
        break;
      case Kind::frame:
        name += padded(image.frame, part.digits);
        break;
    }
  }
  const std::filesystem::path path = contained(name);
  return folder_ == "." ? path : folder_ / path;
}

}  // namespace heliograph::cli
