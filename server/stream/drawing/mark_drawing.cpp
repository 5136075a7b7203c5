#include "stream/drawing/mark_drawing.hpp"

#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>

#ifdef __SANITIZE_ADDRESS__
/// Patterns of fontconfig refer to their parts by offsets, which the leak sanitizer does not see.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig";
}
#endif

namespace heliograph::stream {
namespace {

/// Sizes are those of an image of so many rows, in pixels. They grow with the image, and become no
/// smaller than text that can be read.
constexpr double rows_of_sizes = 720.0;
constexpr double least_scale = 0.9;

constexpr const char* font_family = "Sans";
constexpr double font_size = 13.0;
constexpr double number_size = 9.5;
constexpr int wrap_characters = 30;
constexpr int most_lines = 4;
constexpr double line_width = 2.0;
constexpr double thin_line_width = 1.2;
constexpr double line_edge = 1.0;  // on either side
constexpr double point_radius = 3.5;
constexpr double pin_radius = 8.0;
constexpr double pin_ring = 2.0;
constexpr double hidden_opacity = 0.3;
constexpr double plate_corner = 6.0;
constexpr double plate_padding_x = 7.0;
constexpr double plate_padding_y = 3.0;
constexpr double plate_margin = 2.0;  // to the sides of the image

struct Ink {
  double red, green, blue, opacity;
};
constexpr Ink edge_ink{0.0, 0.0, 0.0, 0.67};
constexpr Ink measure_ink{1.0, 0.722, 0.29, 1.0};
constexpr Ink pin_ink{0.11, 0.42, 0.86, 1.0};
constexpr Ink white_ink{1.0, 1.0, 1.0, 1.0};
constexpr Ink plate_ink{0.07, 0.08, 0.1, 0.86};
constexpr Ink plate_border{1.0, 1.0, 1.0, 0.28};
constexpr Ink text_ink{0.96, 0.97, 0.98, 1.0};
constexpr double author_shade = 0.75;  // of the text's color

template <auto free_it>
struct FreedBy {
  template <class T>
  void operator()(T* object) const {
    free_it(object);
  }
};
using Surface = std::unique_ptr<cairo_surface_t, FreedBy<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, FreedBy<cairo_destroy>>;
using Layout = std::unique_ptr<PangoLayout, FreedBy<g_object_unref>>;
using Font = std::unique_ptr<PangoFontDescription, FreedBy<pango_font_description_free>>;
using FontOptions = std::unique_ptr<cairo_font_options_t, FreedBy<cairo_font_options_destroy>>;

/// In one line, and without what is no character.
std::string one_line(const std::string& text) {
  const std::unique_ptr<gchar, FreedBy<g_free>> valid(
      g_utf8_make_valid(text.data(), static_cast<gssize>(text.size())));
  std::string line = valid.get();
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return line;
}

/// A text that is laid out, and what it occupies, pixels.
struct SetText {
  Layout layout;
  double left = 0.0;  // of the ink's box, from the layout's origin
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
};

class MarkPainter {
 public:
  MarkPainter(cairo_surface_t* layer, std::uint32_t width, std::uint32_t height)
      : context_(cairo_create(layer)),
        width_(width),
        height_(height),
        scale_(std::max(least_scale, height_ / rows_of_sizes)) {
    cairo_set_line_cap(context(), CAIRO_LINE_CAP_ROUND);
  }

  void draw(const ImageMarks& marks) {
    for (const MarkLine& line : marks.lines) draw_line(line, edge_ink, 2.0 * line_edge);
    for (const MarkLine& line : marks.lines) draw_line(line, measure_ink, 0.0);
    for (const MarkPoint& point : marks.points) draw_point(point);
    for (const MarkPin& pin : marks.pins) draw_pin(pin);
    for (const MarkLabel& label : marks.labels) draw_label(label);
    for (const MarkPin& pin : marks.pins) {
      if (!pin.hidden) draw_note(pin);
    }
    if (const cairo_status_t status = cairo_status(context()); status != CAIRO_STATUS_SUCCESS) {
      throw std::runtime_error(std::string("Cairo: ") + cairo_status_to_string(status));
    }
  }

 private:
  cairo_t* context() const { return context_.get(); }
  double x(const MarkPoint& point) const { return point.x * width_; }
  double y(const MarkPoint& point) const { return point.y * height_; }

  void use(const Ink& ink) {
    cairo_set_source_rgba(context(), ink.red, ink.green, ink.blue, ink.opacity);
  }

  void draw_line(const MarkLine& line, const Ink& ink, double wider) {
    use(ink);
    cairo_set_line_width(context(), scale_ * ((line.thin ? thin_line_width : line_width) + wider));
    cairo_move_to(context(), x(line.from), y(line.from));
    cairo_line_to(context(), x(line.to), y(line.to));
    cairo_stroke(context());
  }

  void fill_circle(const MarkPoint& at, double radius, const Ink& ink) {
    use(ink);
    cairo_arc(context(), x(at), y(at), scale_ * radius, 0.0, 2.0 * std::numbers::pi);
    cairo_fill(context());
  }

  void draw_point(const MarkPoint& point) {
    fill_circle(point, point_radius + line_edge, edge_ink);
    fill_circle(point, point_radius, measure_ink);
  }

  void draw_pin(const MarkPin& pin) {
    if (pin.hidden) cairo_push_group(context());
    fill_circle(pin.at, pin_radius + pin_ring + line_edge, edge_ink);
    fill_circle(pin.at, pin_radius + pin_ring, white_ink);
    fill_circle(pin.at, pin_radius, pin_ink);
    const SetText number = set(std::to_string(pin.number), number_size, true);
    // A number of many digits fits into the pin.
    const double fit = std::min(1.0, 1.7 * scale_ * pin_radius / std::max(1.0, number.width));
    cairo_save(context());
    cairo_translate(context(), x(pin.at), y(pin.at));
    cairo_scale(context(), fit, fit);
    show(number, -0.5 * number.width, -0.5 * number.height);
    cairo_restore(context());
    if (!pin.hidden) return;
    cairo_pop_group_to_source(context());
    cairo_paint_with_alpha(context(), hidden_opacity);
  }

  void draw_label(const MarkLabel& label) {
    const SetText text = set(one_line(label.text), font_size, false);
    draw_plate(text, x(label.at) - 0.5 * plate_width(text), y(label.at));
  }

  /// On the right of the pin, or on the left where the image ends.
  void draw_note(const MarkPin& pin) {
    const SetText text = set_note(one_line(pin.author), one_line(pin.text));
    const double away = scale_ * (pin_radius + pin_ring + 5.0);
    double left = x(pin.at) + away;
    if (left + plate_width(text) > width_ - scale_ * plate_margin) {
      left = x(pin.at) - away - plate_width(text);
    }
    draw_plate(text, left, y(pin.at));
  }

  double plate_width(const SetText& text) const {
    return text.width + 2.0 * scale_ * plate_padding_x;
  }

  /// Within the image, as far as it fits. `middle`: of its height.
  void draw_plate(const SetText& text, double left, double middle) {
    const double margin = scale_ * plate_margin;
    const double width = plate_width(text);
    const double height = text.height + 2.0 * scale_ * plate_padding_y;
    left = std::max(margin, std::min(left, width_ - margin - width));
    const double top = std::max(margin, std::min(middle - 0.5 * height, height_ - margin - height));
    outline(left, top, width, height);
    use(plate_ink);
    cairo_fill_preserve(context());
    use(plate_border);
    cairo_set_line_width(context(), scale_);
    cairo_stroke(context());
    use(text_ink);
    show(text, left + scale_ * plate_padding_x, top + scale_ * plate_padding_y);
  }

  /// A rectangle with round corners.
  void outline(double left, double top, double width, double height) {
    constexpr double quarter = 0.5 * std::numbers::pi;
    const double radius = std::min(scale_ * plate_corner, 0.5 * height);
    const double x0 = left + radius, x1 = left + width - radius;
    const double y0 = top + radius, y1 = top + height - radius;
    cairo_new_sub_path(context());
    cairo_arc(context(), x1, y0, radius, -quarter, 0.0);
    cairo_arc(context(), x1, y1, radius, 0.0, quarter);
    cairo_arc(context(), x0, y1, radius, quarter, 2.0 * quarter);
    cairo_arc(context(), x0, y0, radius, 2.0 * quarter, 3.0 * quarter);
    cairo_close_path(context());
  }

  Layout new_layout(double size, bool bold) {
    Layout layout(pango_cairo_create_layout(context()));
    // The same on every system: gray levels, places and shapes that no screen's grid changes.
    PangoContext* const fonts = pango_layout_get_context(layout.get());
    const FontOptions options(cairo_font_options_create());
    cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(fonts, options.get());
    pango_layout_context_changed(layout.get());
    const Font font(pango_font_description_new());
    pango_font_description_set_family_static(font.get(), font_family);
    pango_font_description_set_absolute_size(font.get(), scale_ * size * PANGO_SCALE);
    if (bold) pango_font_description_set_weight(font.get(), PANGO_WEIGHT_BOLD);
    pango_layout_set_font_description(layout.get(), font.get());
    return layout;
  }

  SetText set(const std::string& text, double size, bool bold) {
    Layout layout = new_layout(size, bold);
    pango_layout_set_text(layout.get(), text.data(), static_cast<int>(text.size()));
    return measured(std::move(layout));
  }

  /// The author in bold, then the text, wrapped; what does not fit ends in "…".
  SetText set_note(const std::string& author, const std::string& text) {
    Layout layout = new_layout(font_size, false);
    const std::string all = author.empty() ? text : author + "  " + text;
    pango_layout_set_text(layout.get(), all.data(), static_cast<int>(all.size()));
    pango_layout_set_width(layout.get(), wrap_width(layout.get()));
    pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
    pango_layout_set_height(layout.get(), -most_lines);
    pango_layout_set_ellipsize(layout.get(), PANGO_ELLIPSIZE_END);
    const auto shade = [](double channel) {
      return static_cast<guint16>(channel * author_shade * 65535.0);
    };
    PangoAttrList* const attributes = pango_attr_list_new();
    for (PangoAttribute* const attribute :
         {pango_attr_weight_new(PANGO_WEIGHT_BOLD),
          pango_attr_foreground_new(shade(text_ink.red), shade(text_ink.green),
                                    shade(text_ink.blue))}) {
      attribute->start_index = 0;
      attribute->end_index = static_cast<guint>(author.size());
      pango_attr_list_insert(attributes, attribute);
    }
    pango_layout_set_attributes(layout.get(), attributes);
    pango_attr_list_unref(attributes);
    return measured(std::move(layout));
  }

  /// In units of Pango: of so many characters, at most what the image has room for.
  int wrap_width(PangoLayout* layout) const {
    PangoContext* const fonts = pango_layout_get_context(layout);
    PangoFontMetrics* const metrics = pango_context_get_metrics(
        fonts, pango_layout_get_font_description(layout), pango_context_get_language(fonts));
    const int characters = wrap_characters * pango_font_metrics_get_approximate_char_width(metrics);
    pango_font_metrics_unref(metrics);
    const double room = width_ - 2.0 * scale_ * (plate_padding_x + plate_margin);
    return std::min(characters, static_cast<int>(std::max(1.0, room) * PANGO_SCALE));
  }

  SetText measured(Layout layout) const {
    PangoRectangle box;
    pango_layout_get_extents(layout.get(), nullptr, &box);
    const auto pixels = [](int units) { return static_cast<double>(units) / PANGO_SCALE; };
    return {.layout = std::move(layout),
            .left = pixels(box.x),
            .top = pixels(box.y),
            .width = pixels(box.width),
            .height = pixels(box.height)};
  }

  void show(const SetText& text, double left, double top) {
    use(text_ink);
    cairo_move_to(context(), left - text.left, top - text.top);
    pango_cairo_show_layout(context(), text.layout.get());
  }

  const Context context_;
  const double width_;
  const double height_;
  const double scale_;
};

std::uint8_t rounded(std::uint32_t value, std::uint32_t divisor) {
  return static_cast<std::uint8_t>(std::min(255u, (value + divisor / 2) / divisor));
}

/// Puts a pixel of Cairo, whose color is premultiplied, over one of an image.
void put_over(std::uint32_t argb, std::uint8_t* pixel, Alpha alpha) {
  const std::uint32_t over = argb >> 24;
  const std::uint32_t color[3] = {argb >> 16 & 0xff, argb >> 8 & 0xff, argb & 0xff};
  const std::uint32_t below = alpha == Alpha::kept ? pixel[3] : 255;
  const std::uint32_t share = below * (255 - over);  // of 255 * 255, of the image's color
  const std::uint32_t total = 255 * over + share;    // likewise; not 0, since `over` is not
  for (int channel = 0; channel < 3; ++channel) {
    pixel[channel] = rounded(255 * (255 * color[channel]) + pixel[channel] * share, total);
  }
  if (alpha == Alpha::kept) pixel[3] = rounded(total, 255);
}

void put_layer(cairo_surface_t* layer, std::span<std::uint8_t> rgba, std::uint32_t width,
               std::uint32_t height, Alpha alpha) {
  cairo_surface_flush(layer);
  const unsigned char* const data = cairo_image_surface_get_data(layer);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(layer));
  for (std::size_t row = 0; row < height; ++row) {
    const auto* const drawn = reinterpret_cast<const std::uint32_t*>(data + row * stride);
    std::uint8_t* const pixels = &rgba[4 * row * width];
    for (std::size_t column = 0; column < width; ++column) {
      if (drawn[column] >> 24 != 0) put_over(drawn[column], pixels + 4 * column, alpha);
    }
  }
}

}  // namespace

/// Without any font Pango would end the process.
const std::optional<std::string>& marks_unavailable() {
  static const std::optional<std::string> reason = []() -> std::optional<std::string> {
    const FcFontSet* const fonts = FcConfigGetFonts(FcConfigGetCurrent(), FcSetSystem);
    if (fonts && fonts->nfont > 0) return std::nullopt;
    return "the server's system has no fonts, such as those of the package fonts-dejavu-core";
  }();
  return reason;
}

void draw_marks(std::span<std::uint8_t> rgba, std::uint32_t width, std::uint32_t height,
                const ImageMarks& marks, Alpha alpha) {
  if (!ImageView{.width = width, .height = height, .rgba = rgba}.complete()) {
    throw std::invalid_argument("the pixels do not have the size of the image");
  }
  if (marks.empty()) return;
  if (const auto& reason = marks_unavailable()) throw std::runtime_error(*reason);
  const Surface layer(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(width),
                                                 static_cast<int>(height)));
  MarkPainter(layer.get(), width, height).draw(marks);
  put_layer(layer.get(), rgba, width, height, alpha);
}

}  // namespace heliograph::stream
