#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

extern "C" {
#include <libavcodec/avcodec.h>

#include <stdexcept>
}

#include "stream/encoders/frame_encoder.hpp"

namespace heliograph::stream {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

struct VideoPixels {
  std::uint32_t width;
  std::uint32_t height;
  std::vector<std::uint8_t> rgba;

  VideoPixels(std::uint32_t w, std::uint32_t h) : width(w), height(h), rgba(4ull * w * h, 255) {}
  ImageView view() const { return {.width = width, .height = height, .rgba = rgba}; }
  std::uint8_t* at(std::uint32_t x, std::uint32_t y) { return &rgba[4ull * (y * width + x)]; }
};

/// Smooth colours that move to the left by two pixels a frame.
VideoPixels moving_image(std::uint32_t width, std::uint32_t height, int frame) {
  VideoPixels image(width, height);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double u = (static_cast<double>(x) + 2.0 * frame) * 0.05;
      const double v = static_cast<double>(y) * 0.07;
      std::uint8_t* const pixel = image.at(x, y);
      pixel[0] = static_cast<std::uint8_t>(128 + 100 * std::sin(u));
      pixel[1] = static_cast<std::uint8_t>(128 + 100 * std::cos(u + v));
      pixel[2] = static_cast<std::uint8_t>(128 + 100 * std::sin(v));
    }
  }
  return image;
}

/// libavcodec's decoder, used as by a viewer.
class Decoder {
 public:
  Decoder() : context_(avcodec_alloc_context3(avcodec_find_decoder(AV_CODEC_ID_H264))) {
    context_->flags |= AV_CODEC_FLAG_LOW_DELAY;
    context_->err_recognition = AV_EF_EXPLODE;
    context_->thread_count = 1;
    if (avcodec_open2(context_, nullptr, nullptr) < 0) throw std::runtime_error("no decoder");
  }
  ~Decoder() {
    avcodec_free_context(&context_);
    av_frame_free(&frame_);
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  /// The decoded image of this access unit; null if there is none.
  const AVFrame* decode(const std::vector<std::uint8_t>& unit) {
    std::vector<std::uint8_t> padded = unit;
    padded.resize(unit.size() + AV_INPUT_BUFFER_PADDING_SIZE);
    AVPacket* packet = av_packet_alloc();
    packet->data = padded.data();
    packet->size = static_cast<int>(unit.size());
    const bool taken = avcodec_send_packet(context_, packet) >= 0;
    av_packet_free(&packet);
    // A decoder without delay still keeps the image until the next packet or the end.
    return taken && avcodec_receive_frame(context_, frame_) >= 0 ? frame_ : nullptr;
  }

 private:
  AVCodecContext* context_;
  AVFrame* frame_ = av_frame_alloc();
};

/// BT.709, limited range, back to RGB; colours are not interpolated.
std::array<double, 3> rgb_at(const AVFrame& frame, std::uint32_t x, std::uint32_t y) {
  const auto sample = [&](int plane, std::uint32_t px, std::uint32_t py) {
    return static_cast<double>(frame.data[plane][py * frame.linesize[plane] + px]);
  };
  const double luma = (sample(0, x, y) - 16) / 219;
  const double blue = (sample(1, x / 2, y / 2) - 128) / 224;
  const double red = (sample(2, x / 2, y / 2) - 128) / 224;
  return {255 * (luma + 1.5748 * red), 255 * (luma - 0.1873 * blue - 0.4681 * red),
          255 * (luma + 1.8556 * blue)};
}

/// In decibels.
double signal_to_noise(const AVFrame& frame, const VideoPixels& truth) {
  double sum = 0.0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const auto ux = static_cast<std::uint32_t>(x);
      const auto uy = static_cast<std::uint32_t>(y);
      const auto rgb = rgb_at(frame, ux, uy);
      for (std::size_t c = 0; c < 3; ++c) {
        const double error = rgb[c] - truth.rgba[4ull * (uy * truth.width + ux) + c];
        sum += error * error;
      }
    }
  }
  return 10 * std::log10(255 * 255 * 3.0 * frame.width * frame.height / sum);
}

/// The types of the NAL units of an Annex B access unit.
std::vector<int> unit_types(const std::vector<std::uint8_t>& bytes) {
  std::vector<int> types;
  for (std::size_t i = 0; i + 3 < bytes.size(); ++i) {
    if (bytes[i] == 0 && bytes[i + 1] == 0 && bytes[i + 2] == 1) types.push_back(bytes[i + 3] & 31);
  }
  return types;
}

constexpr int slice = 1;
constexpr int key_slice = 5;
constexpr int sequence_parameters = 7;
constexpr int parameter_set = 8;

bool holds(const std::vector<int>& types, int type) {
  return std::find(types.begin(), types.end(), type) != types.end();
}

class H264Test : public testing::Test {
 protected:
  void SetUp() override {
    if (h264_unavailable()) GTEST_SKIP() << *h264_unavailable();
  }
};

TEST_F(H264Test, EncodesEveryFrameWithoutDelay) {
  H264Encoder encoder(320, 180);
  Decoder decoder;
  for (int i = 0; i < 12; ++i) {
    const VideoPixels image = moving_image(320, 180, i);
    const auto unit =
        encoder.encode(image.view(), {.quality = 85, .max_bytes_per_frame = unlimited}, i == 0);
    EXPECT_EQ(unit.key, i == 0);
    const AVFrame* const decoded = decoder.decode(unit.bytes);
    ASSERT_TRUE(decoded) << "frame " << i;
    EXPECT_GT(signal_to_noise(*decoded, image), 34.0) << "frame " << i;
  }
}

TEST_F(H264Test, SignalsItsColourSpace) {
  H264Encoder encoder(64, 64);
  Decoder decoder;
  VideoPixels image(64, 64);
  constexpr std::array<std::array<std::uint8_t, 3>, 8> colours{{{255, 0, 0},
                                                                {0, 255, 0},
                                                                {0, 0, 255},
                                                                {255, 255, 255},
                                                                {0, 0, 0},
                                                                {128, 128, 128},
                                                                {200, 120, 40},
                                                                {20, 90, 160}}};
  for (std::uint32_t y = 0; y < 64; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      const auto& colour = colours[(x / 32) * 4 + y / 16];
      std::copy(colour.begin(), colour.end(), image.at(x, y));
    }
  }
  const auto unit =
      encoder.encode(image.view(), {.quality = 100, .max_bytes_per_frame = unlimited}, true);
  const AVFrame* const decoded = decoder.decode(unit.bytes);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->color_range, AVCOL_RANGE_MPEG);
  EXPECT_EQ(decoded->colorspace, AVCOL_SPC_BT709);
  EXPECT_EQ(decoded->color_primaries, AVCOL_PRI_BT709);
  EXPECT_EQ(decoded->color_trc, AVCOL_TRC_IEC61966_2_1);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const auto x = static_cast<std::uint32_t>(i / 4 * 32 + 16);
    const auto y = static_cast<std::uint32_t>(i % 4 * 16 + 8);
    const auto rgb = rgb_at(*decoded, x, y);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], colours[i][c], 6) << i;
  }
}

TEST_F(H264Test, KeyFramesComeOnRequestWithTheirParameters) {
  H264Encoder encoder(160, 96);
  for (int i = 0; i < 8; ++i) {
    // A scene change in the middle must not cause a key frame.
    const VideoPixels image = moving_image(160, 96, i < 5 ? i : 1000 + 37 * i);
    const bool asked = i == 0 || i == 3;
    const auto unit =
        encoder.encode(image.view(), {.quality = 80, .max_bytes_per_frame = unlimited}, asked);
    const auto types = unit_types(unit.bytes);
    EXPECT_EQ(unit.key, asked) << "frame " << i;
    EXPECT_EQ(holds(types, key_slice), asked) << "frame " << i;
    EXPECT_EQ(holds(types, sequence_parameters), asked) << "frame " << i;
    EXPECT_EQ(holds(types, parameter_set), asked) << "frame " << i;
    EXPECT_EQ(holds(types, slice), !asked) << "frame " << i;
  }
}

TEST_F(H264Test, AViewerCanStartAtALaterKeyFrame) {
  H264Encoder encoder(160, 96);
  Decoder late;
  for (int i = 0; i < 6; ++i) {
    const VideoPixels image = moving_image(160, 96, i);
    const auto unit =
        encoder.encode(image.view(), {.quality = 85, .max_bytes_per_frame = unlimited}, i % 3 == 0);
    if (i < 3) continue;
    const AVFrame* const decoded = late.decode(unit.bytes);
    ASSERT_TRUE(decoded);
    EXPECT_GT(signal_to_noise(*decoded, image), 32.0);
  }
}

TEST_F(H264Test, KeepsTheRateAndFollowsItsChanges) {
  H264Encoder encoder(320, 180);
  std::mt19937 random(7);
  const auto mean_bytes = [&](double limit) {
    double sum = 0.0;
    constexpr int frames = 40;
    for (int i = 0; i < frames; ++i) {
      VideoPixels noise(320, 180);
      for (std::uint8_t& value : noise.rgba) value = static_cast<std::uint8_t>(random());
      sum += static_cast<double>(
          encoder.encode(noise.view(), {.quality = 80, .max_bytes_per_frame = limit}, i == 0)
              .bytes.size());
    }
    return sum / frames;
  };
  const double free = mean_bytes(unlimited);
  EXPECT_GT(free, 20'000);
  EXPECT_LT(mean_bytes(12'000), 1.35 * 12'000);
  EXPECT_LT(mean_bytes(6'000), 1.35 * 6'000);
  EXPECT_GT(mean_bytes(unlimited), 0.7 * free);
}

TEST_F(H264Test, CropsAnOddLastColumnAndRow) {
  H264Encoder encoder(161, 97);
  EXPECT_EQ(encoder.width(), 160u);
  EXPECT_EQ(encoder.height(), 96u);
  Decoder decoder;
  const VideoPixels image = moving_image(161, 97, 0);
  const auto unit =
      encoder.encode(image.view(), {.quality = 85, .max_bytes_per_frame = unlimited}, true);
  const AVFrame* const decoded = decoder.decode(unit.bytes);
  ASSERT_TRUE(decoded);
  EXPECT_GT(signal_to_noise(*decoded, image), 34.0);
}

TEST_F(H264Test, AVideoRestartsWhenTheSizeChanges) {
  JpegEncoder jpeg;
  FrameEncoder encoder(jpeg);
  const EncodingVariant variant{.codec = protocol::StreamCodec::h264, .quality = 80};
  const auto encode = [&](std::uint32_t side, bool key) {
    return encoder.encode(moving_image(side, side, 0).view(), {.variant = variant, .key = key});
  };
  const auto first = encode(64, true);
  const auto second = encode(64, false);
  EXPECT_TRUE(second->video->follows(*first->video));
  EXPECT_FALSE(second->header.flags & protocol::frame_flag::key);
  const auto resized = encode(96, false);
  EXPECT_TRUE(resized->header.flags & protocol::frame_flag::key) << "it could not be decoded";
  EXPECT_NE(resized->video->video, first->video->video);
  EXPECT_EQ(resized->header.width, 96);
  const auto tiny = encode(1, false);
  EXPECT_EQ(tiny->header.codec, protocol::FrameCodec::jpeg);
  EXPECT_EQ(tiny->variant, VariantPlanner::jpeg_fallback(variant));
}

TEST(ImageScaler, KeepsTheMeanAndTheEdges) {
  VideoPixels image(40, 24);
  for (std::uint32_t y = 0; y < 24; ++y) {
    for (std::uint32_t x = 20; x < 40; ++x) image.at(x, y)[0] = 0;
  }
  ImageScaler scaler;
  for (const int percent : {100, 75, 50, 33}) {
    const ImageView small = scaler.scale(image.view(), percent);
    EXPECT_EQ(small.width, static_cast<std::uint32_t>(std::lround(40 * percent / 100.0)));
    ASSERT_TRUE(small.complete());
    double red = 0.0;
    for (std::size_t i = 0; i < small.rgba.size(); i += 4) red += small.rgba[i];
    EXPECT_NEAR(red / (small.rgba.size() / 4.0), 127.5, 1.5) << percent;
    EXPECT_EQ(small.rgba[0], 255);
    EXPECT_EQ(small.rgba[4 * (small.width - 1)], 0);
  }
}

}  // namespace
}  // namespace heliograph::stream
