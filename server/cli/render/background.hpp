#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/api/renderer.hpp"

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
  /// Linear.
  const std::array<float, 3>& color() const { return color_; }

 private:
  enum class Kind { sky, blurred, transparent, color };
  Kind kind_ = Kind::sky;
  std::array<float, 3> color_{};
};

/// How much of each pixel surfaces cover, as the mean of the jittered samples of a static view.
class Coverage {
 public:
  /// Adds the renderer's last frame, unless it belongs to no mean.
  /// @throws std::runtime_error where the frame has no G-buffer
  void add(render::Renderer& renderer, const render::Frame& frame);
  /// 0 to 1 for each pixel.
  std::vector<float> mean() const;

 private:
  std::vector<float> sum_;
  std::uint32_t count_ = 0;
  std::uint32_t samples_ = 0;
};

/// Puts the background behind an image of the scene on black: sRGB, RGBA. What shines without
/// covering, such as reflections in glass, adds to it.
void put_background(std::span<std::uint8_t> rgba, const std::vector<float>& coverage,
                    const Background& background);

}  // namespace heliograph::cli
