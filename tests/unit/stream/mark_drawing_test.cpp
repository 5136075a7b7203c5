#include "stream/drawing/mark_drawing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace heliograph::stream {
namespace {

/// The part of an image that drawing has changed: pixels, the last ones excluded.
struct ChangedBox {
  std::uint32_t left, top, right, bottom;
  std::size_t pixels = 0;

  std::uint32_t width() const { return right - left; }
  std::uint32_t height() const { return bottom - top; }
};

struct Canvas {
  std::uint32_t width;
  std::uint32_t height;
  std::vector<std::uint8_t> rgba;

  Canvas(std::uint32_t w, std::uint32_t h, std::uint8_t gray = 128)
      : width(w), height(h), rgba(4ull * w * h, gray) {}

  void draw(const ImageMarks& marks, Alpha alpha = Alpha::ignored) {
    draw_marks(rgba, width, height, marks, alpha);
  }
  const std::uint8_t* at(std::uint32_t x, std::uint32_t y) const {
    return &rgba[4ull * (y * width + x)];
  }
  ChangedBox changed(const Canvas& before) const {
    ChangedBox box{.left = width, .top = height, .right = 0, .bottom = 0};
    for (std::uint32_t y = 0; y < height; ++y) {
      for (std::uint32_t x = 0; x < width; ++x) {
        if (std::equal(at(x, y), at(x, y) + 4, before.at(x, y))) continue;
        box.left = std::min(box.left, x);
        box.top = std::min(box.top, y);
        box.right = std::max(box.right, x + 1);
        box.bottom = std::max(box.bottom, y + 1);
        ++box.pixels;
      }
    }
    return box;
  }
};

ImageMarks with_pin(const std::string& text, bool hidden = false,
                    const std::string& author = "Ada") {
  return {
      .pins = {{.at = {0.5, 0.5}, .number = 7, .author = author, .text = text, .hidden = hidden}}};
}

ChangedBox drawn(const ImageMarks& marks, std::uint32_t width = 640, std::uint32_t height = 360) {
  const Canvas before(width, height);
  Canvas canvas = before;
  canvas.draw(marks);
  return canvas.changed(before);
}

class MarkDrawing : public testing::Test {
 protected:
  void SetUp() override {
    if (marks_unavailable()) GTEST_SKIP() << *marks_unavailable();
  }
};

TEST(MarkDrawingWithoutMarks, LeavesEveryByte) {
  Canvas canvas(64, 48, 77);
  canvas.rgba[10] = 3;
  const auto before = canvas.rgba;
  if (marks_unavailable()) {
    EXPECT_THROW(canvas.draw(with_pin("text")), std::runtime_error);
  } else {
    canvas.draw({});
  }
  EXPECT_EQ(canvas.rgba, before);
}

TEST_F(MarkDrawing, RefusesPixelsOfAnotherSize) {
  Canvas canvas(64, 48);
  EXPECT_THROW(draw_marks(canvas.rgba, 65, 48, with_pin("text")), std::invalid_argument);
}

TEST_F(MarkDrawing, ChangesPixelsNearTheMarksOnly) {
  const ChangedBox line = drawn({.lines = {{.from = {0.25, 0.5}, .to = {0.75, 0.5}}}});
  EXPECT_NEAR(line.left, 160, 4);
  EXPECT_NEAR(line.right, 480, 4);
  EXPECT_LE(line.height(), 8u);
  const ChangedBox point = drawn({.points = {{.x = 0.5, .y = 0.25}}});
  EXPECT_NEAR(0.5 * (point.left + point.right), 320, 1);
  EXPECT_NEAR(0.5 * (point.top + point.bottom), 90, 1);
  EXPECT_LE(point.width(), 12u);
  const ChangedBox label = drawn({.labels = {{.at = {0.5, 0.75}, .text = "1.25 m"}}});
  EXPECT_NEAR(0.5 * (label.left + label.right), 320, 1.5);
  EXPECT_NEAR(0.5 * (label.top + label.bottom), 270, 1.5);
  EXPECT_LE(label.width(), 80u);
  EXPECT_GT(label.width(), 2 * label.height());
}

TEST_F(MarkDrawing, SizesFollowTheHeightOfTheImage) {
  const ImageMarks marks{.labels = {{.at = {0.5, 0.5}, .text = "1.25 m"}}};
  const ChangedBox hd = drawn(marks, 1920, 1080), four = drawn(marks, 3840, 2160);
  EXPECT_NEAR(four.height(), 2.0 * hd.height(), 4);
  EXPECT_GT(drawn(marks, 512, 288).height(), 14u) << "it can be read";
}

TEST_F(MarkDrawing, TextsAreLightOnADarkPlateOnAnyBackground) {
  for (const std::uint8_t gray : {0, 255}) {
    Canvas canvas(640, 360, gray);
    canvas.draw({.labels = {{.at = {0.5, 0.5}, .text = "88888888"}}});
    std::size_t dark = 0, light = 0;
    for (std::uint32_t x = 300; x < 340; ++x) {
      for (std::uint32_t y = 175; y < 185; ++y) {
        dark += canvas.at(x, y)[1] < 70;
        light += canvas.at(x, y)[1] > 200;
      }
    }
    EXPECT_GT(dark, 40u);
    EXPECT_GT(light, 40u);
  }
}

TEST_F(MarkDrawing, LongTextsAreWrappedAndCut) {
  std::string words;
  for (int i = 0; i < 60; ++i) words += "crack ";
  const ChangedBox one = drawn(with_pin("crack")), all = drawn(with_pin(words));
  const ChangedBox more = drawn(with_pin(words + words));
  EXPECT_LT(all.height(), 5 * one.height());
  EXPECT_EQ(more.height(), all.height());
  EXPECT_EQ(more.width(), all.width());
  EXPECT_LT(all.width(), 300u);
  EXPECT_LT(drawn(with_pin(std::string(2000, 'x'))).height(), 5 * one.height());
  EXPECT_LT(drawn(with_pin("1\n2\n3\n4\n5\n6\n7\n8")).height(), 2 * one.height());
}

TEST_F(MarkDrawing, HiddenPinsAreFaintAndHaveNoText) {
  const Canvas before(640, 360, 0);
  Canvas seen = before, hidden = before;
  seen.draw(with_pin("A long text beside the pin"));
  hidden.draw(with_pin("A long text beside the pin", true));
  EXPECT_LT(hidden.changed(before).width(), 30u);
  EXPECT_GT(seen.changed(before).width(), 100u);
  const std::uint32_t ring = 320 + 8;  // in the ring around the pin
  EXPECT_NEAR(hidden.at(ring, 180)[0], 0.3 * seen.at(ring, 180)[0], 4);
}

TEST_F(MarkDrawing, TextsStayWithinTheImage) {
  ImageMarks marks = with_pin("A text on the left of its pin, where the image ends");
  marks.pins[0].at = {0.99, 0.99};
  const ChangedBox box = drawn(marks);
  EXPECT_LT(box.left, 500u);
  EXPECT_EQ(box.right, 640u) << "the pin is cut off";
  EXPECT_LE(drawn({.labels = {{.at = {0.0, 0.0}, .text = "1.25 m"}}}).left, 3u);
  EXPECT_GT(drawn(with_pin("narrow"), 16, 16).pixels, 0u);
}

TEST_F(MarkDrawing, DrawsEveryScript) {
  for (const std::string text :
       {"Ein Riß", "Трещина", "Ρωγμή", "ひび割れ", "裂缝", "균열", "شق في السطح", "סדק", "दरार",
        "🔎", "a\u0301\u200d\u2028x", "\xff\xfe broken", ""}) {
    EXPECT_GT(drawn(with_pin(text, false, text)).pixels, 100u) << text;
    EXPECT_GT(drawn({.labels = {{.at = {0.5, 0.5}, .text = text}}}).pixels, 50u) << text;
  }
  const std::string with_null("a\0b", 3);
  EXPECT_GT(drawn(with_pin(with_null)).pixels, 100u);
}

TEST_F(MarkDrawing, LinesFarOutsideOfTheImageAreCutOff) {
  const ChangedBox box = drawn({.lines = {{.from = {-3.0, 0.5}, .to = {4.0, 0.5}}}});
  EXPECT_EQ(box.width(), 640u);
  EXPECT_LE(box.height(), 8u);
}

TEST_F(MarkDrawing, AlphaIsKeptOrThatOfTheMarks) {
  const ImageMarks marks{.points = {{.x = 0.5, .y = 0.5}}};
  Canvas canvas(64, 48, 0);
  canvas.draw(marks);
  EXPECT_EQ(canvas.at(32, 24)[3], 0) << "is left alone";
  canvas = Canvas(64, 48, 0);
  canvas.draw(marks, Alpha::kept);
  EXPECT_EQ(canvas.at(32, 24)[3], 255);
  EXPECT_NEAR(canvas.at(32, 24)[0], 255, 1);
  EXPECT_EQ(canvas.at(32, 10)[3], 0);
}

}  // namespace
}  // namespace heliograph::stream
