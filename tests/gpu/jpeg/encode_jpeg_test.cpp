#include "render/passes/jpeg/encode_jpeg.hpp"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cmath>
#include <functional>
#include <memory>
#include <span>

#include "render/api/renderer.hpp"
#include "render/resources/tables/jpeg_tables.hpp"
#include "shaders/embedded.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Handle = std::unique_ptr<void, int (*)(void*)>;

struct Pixels {
  int width;
  int height;
  Bytes rgba;
};

/// Colours from 0 to 255 by column and row.
using Paint = std::function<glm::ivec3(int, int)>;

Pixels paint(int width, int height, const Paint& color) {
  Pixels image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::ivec3 c = color(x, y);
      for (int i = 0; i < 3; ++i) image.rgba.push_back(static_cast<std::uint8_t>(c[i]));
      image.rgba.push_back(255);
    }
  }
  return image;
}

std::uint32_t random_at(int x, int y) {
  std::uint32_t h =
      static_cast<std::uint32_t>(x) * 0x9e3779b9u ^ static_cast<std::uint32_t>(y) * 0x85ebca6bu;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return h ^ h >> 15;
}

glm::ivec3 flat(int, int) {
  return {37, 201, 118};
}
glm::ivec3 noise(int x, int y) {
  const std::uint32_t h = random_at(x, y);
  return {h & 255, h >> 8 & 255, h >> 16 & 255};
}
/// The most that luma can change from pixel to pixel.
glm::ivec3 black_and_white(int x, int y) {
  return glm::ivec3(random_at(x, y) & 1 ? 255 : 0);
}
glm::ivec3 saturated(int x, int y) {
  const int kind = (x / 5 + y / 3) % 6;
  return {kind < 3 ? 255 : 0, kind % 2 ? 255 : 0, kind % 3 ? 0 : 255};
}
/// The highest frequencies alone: behind long runs of zeros.
glm::ivec3 stripes(int x, int y) {
  return {x & 1 ? 255 : 0, y & 1 ? 255 : 0, x & 1 ? 255 : 0};
}
/// Single pixels, which have every frequency, among blocks of none.
glm::ivec3 dots(int x, int y) {
  return random_at(x, y) % 61 == 0 ? glm::ivec3(255, 127, 0) : glm::ivec3(0, 0, 255);
}
/// Soft shades, edges and some grain, as frames have.
glm::ivec3 scene(int x, int y) {
  const float u = static_cast<float>(x), v = static_cast<float>(y);
  const float tile = (x / 64 + y / 48) % 2 ? 1.0f : 0.6f;
  const float light = 110.0f + 60.0f * std::sin(u * 0.011f) * std::cos(v * 0.017f);
  const float grain = static_cast<float>(random_at(x, y) & 7);
  return glm::ivec3(glm::vec3(tile, tile * 0.9f, 0.75f) * (light + grain));
}

render::DeviceJpeg make_on_device(const Pixels& image,
                                  const std::optional<render::JpegRequest>& request) {
  const gpu::Buffer tables = render::make_jpeg_tables(device());
  const VkExtent2D size{static_cast<std::uint32_t>(image.width),
                        static_cast<std::uint32_t>(image.height)};
  gpu::FramePlan plan(device(), size);
  const gpu::ImageRef shown = plan.image("shown", VK_FORMAT_R8G8B8A8_UNORM);
  plan.get(shown).upload(std::as_bytes(std::span(image.rgba)));
  EXPECT_TRUE(render::can_encode_jpeg(device(), size));
  const render::EncodedOutput encoded =
      render::encode_jpeg(plan, engine().parts().programs, tables, shown, size, request);
  plan.compile();
  plan.execute();
  return render::read_jpeg(plan, encoded, *request);
}

Bytes encode_on_device(const Pixels& image, int quality) {
  return make_on_device(image, render::JpegRequest{.quality = quality}).bytes;
}

/// The mean of the area of each pixel, rounded.
Pixels smaller(const Pixels& image, int width, int height) {
  const auto overlap = [](int at, int whole, int i, int parts) {
    return std::max(0,
                    std::min((at + 1) * whole, (i + 1) * parts) - std::max(at * whole, i * parts));
  };
  return paint(width, height, [&](int x, int y) {
    glm::ivec3 sum(0);
    for (int from_y = y * image.height / height; from_y < image.height; ++from_y) {
      const int high = overlap(y, image.height, from_y, height);
      if (high == 0) break;
      for (int from_x = x * image.width / width; from_x < image.width; ++from_x) {
        const int wide = overlap(x, image.width, from_x, width);
        if (wide == 0) break;
        const std::uint8_t* const c = &image.rgba[std::size_t(4 * (from_y * image.width + from_x))];
        sum += high * wide * glm::ivec3(c[0], c[1], c[2]);
      }
    }
    const int area = image.width * image.height;
    return (sum + area / 2) / area;
  });
}

Bytes encode_by_library(const Pixels& image, int quality, int flags) {
  const Handle handle(tjInitCompress(), tjDestroy);
  unsigned char* made = nullptr;
  unsigned long size = 0;
  EXPECT_EQ(tjCompress2(handle.get(), image.rgba.data(), image.width, 0, image.height, TJPF_RGBX,
                        &made, &size, TJSAMP_420, quality, flags),
            0);
  Bytes bytes(made, made + size);
  tjFree(made);
  return bytes;
}

/// Without a single warning.
Bytes decode(const Bytes& file, const Pixels& like) {
  const Handle handle(tjInitDecompress(), tjDestroy);
  int width = 0, height = 0, sampling = 0, space = 0;
  EXPECT_EQ(tjDecompressHeader3(handle.get(), file.data(), file.size(), &width, &height, &sampling,
                                &space),
            0);
  EXPECT_EQ(width, like.width);
  EXPECT_EQ(height, like.height);
  EXPECT_EQ(sampling, TJSAMP_420);
  EXPECT_EQ(space, TJCS_YCbCr);
  Bytes rgba(like.rgba.size());
  EXPECT_EQ(tjDecompress2(handle.get(), file.data(), file.size(), rgba.data(), width, 0, height,
                          TJPF_RGBA, TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING),
            0)
      << tjGetErrorStr2(handle.get());
  return rgba;
}

double psnr(const Bytes& a, const Bytes& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = double(a[i]) - double(b[i]);
    sum += d * d;
  }
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / std::max(sum, 1e-9));
}

/// As the library's accurate integer DCT makes it, to the last bit.
void expect_same_as_library(const Pixels& image, int quality) {
  const Bytes file = encode_on_device(image, quality);
  ASSERT_FALSE(file.empty());
  const Bytes other = encode_by_library(image, quality, TJFLAG_ACCURATEDCT);
  EXPECT_EQ(decode(file, image), decode(other, image));
}

TEST(EncodeJpeg, DecodesToPixelsOfLibraryInEveryQuality) {
  for (const int quality : {1, 10, 24, 49, 50, 51, 75, 80, 95, 100}) {
    SCOPED_TRACE(quality);
    expect_same_as_library(paint(200, 120, scene), quality);
    expect_same_as_library(paint(72, 40, noise), quality);
  }
}

TEST(EncodeJpeg, DecodesToPixelsOfLibraryInEverySize) {
  const std::pair<int, int> sizes[]{{1, 1},   {2, 1},   {1, 2},   {7, 8},   {8, 7},     {9, 17},
                                    {15, 16}, {16, 15}, {17, 9},  {16, 16}, {17, 17},   {64, 16},
                                    {65, 16}, {63, 33}, {100, 1}, {1, 100}, {1279, 719}};
  for (const auto& [width, height] : sizes) {
    SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
    expect_same_as_library(paint(width, height, scene), 80);
  }
}

TEST(EncodeJpeg, DecodesToPixelsOfLibraryWhateverIsShown) {
  for (const auto color : {flat, noise, black_and_white, saturated, stripes, dots}) {
    for (const int quality : {1, 80, 100}) {
      SCOPED_TRACE(quality);
      expect_same_as_library(paint(133, 71, color), quality);
    }
  }
}

TEST(EncodeJpeg, MakesImageSmallerByMeansOfAreas) {
  const struct {
    int width, height, percent, made_width, made_height;
  } cases[]{{200, 120, 50, 100, 60},  {200, 120, 75, 150, 90}, {133, 71, 50, 67, 36},
            {319, 181, 75, 239, 136}, {3, 1, 1, 1, 1},         {64, 48, 99, 63, 48}};
  for (const auto& one : cases) {
    SCOPED_TRACE(std::to_string(one.width) + "x" + std::to_string(one.height) + " to " +
                 std::to_string(one.percent));
    const Pixels image = paint(one.width, one.height, one.percent == 50 ? noise : scene);
    const render::DeviceJpeg made =
        make_on_device(image, render::JpegRequest{.quality = 80, .percent = one.percent});
    EXPECT_EQ(made.width, std::uint32_t(one.made_width));
    EXPECT_EQ(made.height, std::uint32_t(one.made_height));
    const Pixels mean = smaller(image, one.made_width, one.made_height);
    EXPECT_EQ(decode(made.bytes, mean),
              decode(encode_by_library(mean, 80, TJFLAG_ACCURATEDCT), mean));
  }
}

TEST(EncodeJpeg, ScalesOnlyWhereSumsAreExact) {
  EXPECT_TRUE(render::can_scale_jpeg({4096, 4096}, 50));
  EXPECT_FALSE(render::can_scale_jpeg({4097, 4096}, 50));
  EXPECT_TRUE(render::can_scale_jpeg({8192, 8192}, 100));
}

// The stream's encoder takes the library's fast DCT.
TEST(EncodeJpeg, IsAsGoodAndAsSmallAsStreamedFrames) {
  const Pixels image = paint(640, 360, scene);
  const std::size_t intervals = 40 * 23 / 4;
  for (const int quality : {50, 80, 90}) {
    const Bytes file = encode_on_device(image, quality);
    const Bytes other = encode_by_library(image, quality, 0);
    EXPECT_GT(psnr(decode(file, image), image.rgba), psnr(decode(other, image), image.rgba) - 0.1);
    // A marker, part of a byte and three first differences for each interval.
    EXPECT_LT(file.size(), other.size() + 4 * intervals) << quality;
    if (quality >= 80) {
      EXPECT_LT(20 * file.size(), 21 * other.size()) << quality;
    }
  }
}

TEST(EncodeJpeg, HasRestartMarkersInOrderBetweenIntervals) {
  const Pixels image = paint(300, 200, noise);
  const Bytes file = encode_on_device(image, 90);
  const std::size_t header = render::jpeg_header(300, 200, 90).size();
  ASSERT_GT(file.size(), header);
  std::vector<int> markers;
  for (std::size_t i = header; i + 1 < file.size(); ++i) {
    if (file[i] == 0xff && file[i + 1] != 0) markers.push_back(file[i + 1]);
  }
  const std::size_t mcus = 19 * 13;
  ASSERT_EQ(markers.size(), (mcus + 3) / 4);
  EXPECT_EQ(markers.back(), 0xd9);
  EXPECT_EQ(file.back(), 0xd9);
  for (std::size_t i = 0; i + 1 < markers.size(); ++i) EXPECT_EQ(markers[i], 0xd0 + int(i % 8));
}

TEST(EncodeJpeg, GivesUpFrameOfWhichOneIntervalDoesNotFit) {
  gpu::FramePlan plan(device(), {1, 1});
  const auto buffer = [&plan](const char* name, std::uint64_t words) {
    return plan.buffer(name, 4 * words, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::readback);
  };
  constexpr std::uint32_t intervals = 700;
  const auto lengths = buffer("lengths", intervals);
  const auto places = buffer("places", intervals + 1);
  const auto report = buffer("report", 1);
  plan.pass("place", engine().parts().programs.compute(shaders::jpeg_place, ~0u))
      .read(lengths)
      .write(places)
      .write(report)
      .constants(intervals)
      .dispatch({1, 1});
  plan.compile();
  const auto words = [&plan](gpu::BufferRef of) {
    return reinterpret_cast<std::uint32_t*>(plan.get(of).mapped());
  };
  std::fill_n(words(lengths), intervals, 100u);
  plan.execute();
  for (std::uint32_t i = 0; i <= intervals; ++i) ASSERT_EQ(words(places)[i], 102 * i);
  EXPECT_EQ(*words(report), 102 * intervals);
  words(lengths)[511] = shared::jpeg_too_long;
  plan.execute();
  EXPECT_EQ(words(places)[intervals], 0u);
  EXPECT_EQ(*words(report), 0u);
}

/// Frames of an engine that encodes.
class DeviceJpeg : public testing::Test {
 protected:
  static constexpr std::size_t bytes = 96 * 54 * 4;

  /// With few passes.
  static protocol::Settings plain() {
    protocol::Settings settings = without_indirect();
    settings.specular.enabled = false;
    settings.ambient.occlusion = false;
    return settings;
  }
  explicit DeviceJpeg(bool as_gpu = true)
      : engine_(render::EngineOptions{
            .validation = true, .as_gpu = as_gpu, .jpeg = render::JpegEncoding::on}) {
    SceneBuilder scene;
    scene.place(scene.add_sphere(0.8f, surface({0.9f, 0.3f, 0.2f}, 0.5f)));
    scene.add_sun({0.3f, -0.5f, -1.0f}, {3, 2, 1}, 0.01f);
    renderer_.emplace(engine_);
    EXPECT_TRUE(renderer_->set_settings(plain()));
    renderer_->set_size(96, 54);
    renderer_->set_scene(
        engine_.upload(scene.build(), heliograph::scene::constant_environment(glm::vec3(0.5f))));
    renderer_->set_camera(look({0, 0.4f, 3}, {0, 0, 0}));
  }
  void TearDown() override {
    renderer_.reset();
    EXPECT_EQ(engine_.validation_messages(), 0u);
  }
  static void expect_same_as_library(const render::Frame& frame, Bytes rgba) {
    ASSERT_EQ(rgba.size(), bytes);
    const Pixels pixels{96, 54, std::move(rgba)};
    EXPECT_EQ(
        decode(frame.jpeg.bytes, pixels),
        decode(encode_by_library(pixels, frame.jpeg.made.quality, TJFLAG_ACCURATEDCT), pixels));
  }

  render::Engine engine_;
  std::optional<render::Renderer> renderer_;
};

class HostDeviceJpeg : public DeviceJpeg {
 protected:
  HostDeviceJpeg() : DeviceJpeg(false) {}
};

TEST_F(DeviceJpeg, ComesInPlaceOfPixelsWhichCanBeReadLater) {
  ASSERT_TRUE(engine_.encodes_jpeg());
  EXPECT_EQ(renderer_->render().rgba.size(), bytes);
  renderer_->request_jpeg(render::JpegRequest{.quality = 80});
  const render::Frame frame = renderer_->render();
  EXPECT_EQ(frame.jpeg.made.quality, 80);
  EXPECT_TRUE(frame.rgba.empty());
  expect_same_as_library(frame, renderer_->read_pixels());

  renderer_->request_jpeg({});
  const render::Frame after = renderer_->render();
  EXPECT_TRUE(after.jpeg.bytes.empty());
  EXPECT_EQ(after.rgba.size(), bytes);

  protocol::Settings settings = plain();
  settings.view.buffer = "gbuffer.normals";
  ASSERT_TRUE(renderer_->set_settings(settings));
  renderer_->request_jpeg(render::JpegRequest{.quality = 80});
  const render::Frame view = renderer_->render();
  EXPECT_TRUE(view.jpeg.bytes.empty()) << "debug views are coloured on the host";
  EXPECT_EQ(view.rgba.size(), bytes);
  ASSERT_TRUE(renderer_->set_settings(plain()));
  EXPECT_FALSE(renderer_->render().jpeg.bytes.empty());

  renderer_->set_size(64, 64);
  EXPECT_TRUE(renderer_->read_pixels().empty()) << "what they were in is gone";
  renderer_->buffers();  // makes the next plan
  EXPECT_TRUE(renderer_->read_pixels().empty());
}

/// One plan makes JPEGs of every size, frame by frame.
TEST_F(DeviceJpeg, IsAsSmallAsEachFrameAsksFor) {
  const render::JpegRequest requests[]{
      {.quality = 80}, {.quality = 56, .percent = 50}, {.quality = 90}};
  for (const render::JpegRequest& request : requests) {
    renderer_->request_jpeg(request);
    const render::Frame frame = renderer_->render();
    EXPECT_EQ(frame.jpeg.made, request);
    EXPECT_EQ(frame.width, 96u);
    const Pixels whole{96, 54, renderer_->read_pixels()};
    const int percent = request.percent;
    const Pixels mean = percent == 100 ? whole : smaller(whole, 48, 27);
    EXPECT_EQ(decode(frame.jpeg.bytes, mean),
              decode(encode_by_library(mean, request.quality, TJFLAG_ACCURATEDCT), mean));
  }
}

TEST_F(HostDeviceJpeg, ComesBesidePixelsThatLieInMemoryOfHost) {
  if (!engine_.parts().device.is_cpu()) GTEST_SKIP() << "only on devices that are processors";
  renderer_->request_jpeg(render::JpegRequest{.quality = 70});
  const render::Frame frame = renderer_->render();
  expect_same_as_library(frame, frame.rgba);
}

}  // namespace
}  // namespace heliograph::test
