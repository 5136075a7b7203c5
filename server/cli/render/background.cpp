#include "cli/render/background.hpp"

#include <stdexcept>

#include "protocol/settings/color.hpp"

namespace heliograph::cli {

Background::Background(const std::string& text) {
  if (text == "sky") return;
  if (text == "blurred" || text == "transparent") {
    kind_ = text == "blurred" ? Kind::blurred : Kind::transparent;
    return;
  }
  const auto color = protocol::parse_color(text);
  if (!color) {
    throw std::invalid_argument("--background " + text +
                                ": must be sky, blurred, transparent or a colour such as #ffffff");
  }
  kind_ = Kind::color;
  color_ = protocol::linear(*color);
}

}  // namespace heliograph::cli
