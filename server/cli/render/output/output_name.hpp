#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace heliograph::cli {

/// What a file is an image of.
struct ImageOf {
  std::string scene;
  std::string camera;
  std::uint32_t frame = 0;
};

/// The name of one or several output files, with placeholders: {scene}, {camera}, {frame} and
/// {frame:04}, or printf's %d and %04d for the frame. {{ and }} stand for braces, %% for a percent
/// sign. Folders in the name may have placeholders, too. "-" is standard output.
class OutputName {
 public:
  /// @throws std::invalid_argument
  explicit OutputName(const std::string& text);

  bool is_standard_output() const { return parts_.empty(); }
  bool has_scene() const { return has(Kind::scene); }
  bool has_camera() const { return has(Kind::camera); }
  bool has_frame() const { return has(Kind::frame); }
  /// "run.png" -> "run_{frame:04}.png"
  void add_frame();

  /// The folder of the files, up to the first placeholder: it must exist.
  const std::filesystem::path& folder() const { return folder_; }
  /// ".png"; empty without one.
  std::string extension() const;
  /// Names of scenes and cameras become one path element each: '/' and control characters are
  /// replaced.
  std::filesystem::path file(const ImageOf& image) const;

 private:
  enum class Kind { text, scene, camera, frame };
  struct Part {
    Kind kind = Kind::text;
    std::string text;
    std::size_t digits = 0;  // at least
  };

  bool has(Kind kind) const;
  void add_text(std::string_view text);
  void add_placeholder(std::string_view name);
  /// Reads printf's placeholder at the beginning of `text`; the characters it has, 0 for none.
  std::size_t add_printf(std::string_view text);

  std::filesystem::path folder_;
  std::vector<Part> parts_;  // of the name in the folder; none for standard output
};

}  // namespace heliograph::cli
