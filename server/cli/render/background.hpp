#pragma once

#include <array>
#include <optional>
#include <string>

namespace heliograph::cli {

/// What is behind the scene in an image: its environment, as it is or blurred, nothing, or a
/// colour.
class Background {
 public:
  /// "sky", "blurred", "transparent" or "#rrggbb". @throws std::invalid_argument
  explicit Background(const std::string& text);

  /// Whether the renderer draws it.
  bool is_rendered() const { return kind_ == Kind::sky || kind_ == Kind::blurred; }
  bool is_blurred() const { return kind_ == Kind::blurred; }
  bool is_transparent() const { return kind_ == Kind::transparent; }
  /// Linear; none where it is transparent.
  const std::optional<std::array<float, 3>>& color() const { return color_; }

 private:
  enum class Kind { sky, blurred, transparent, color };
  Kind kind_ = Kind::sky;
  std::optional<std::array<float, 3>> color_;
};

}  // namespace heliograph::cli
