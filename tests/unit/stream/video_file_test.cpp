#include "stream/video/video_file.hpp"

#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>
#include <webp/decode.h>
#include <webp/demux.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "stream/encoders/webp_encoder.hpp"

namespace heliograph::stream {
namespace {

constexpr std::uint32_t width = 48;
constexpr std::uint32_t height = 32;
constexpr int frame_count = 6;

/// One colour, half transparent.
std::vector<std::uint8_t> plain_image(std::uint8_t red) {
  std::vector<std::uint8_t> rgba;
  for (std::uint32_t i = 0; i < width * height; ++i) rgba.insert(rgba.end(), {red, 40, 200, 128});
  return rgba;
}

ImageView view_of(const std::vector<std::uint8_t>& rgba) {
  return {.width = width, .height = height, .rgba = rgba};
}

std::filesystem::path video_path() {
  return std::filesystem::path(testing::TempDir()) / ("video" + std::to_string(getpid()));
}

std::string finished(VideoFile& video, const std::filesystem::path& file) {
  video.finish();
  std::ifstream in(file, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  std::filesystem::remove(file);
  return bytes;
}

std::string written_video(VideoContainer container, double fps) {
  const std::filesystem::path file = video_path();
  VideoFile video(file, {.width = width, .height = height, .fps = fps, .container = container});
  for (int i = 0; i < frame_count; ++i) {
    const auto image = plain_image(static_cast<std::uint8_t>(40 * i));
    video.add(view_of(image));
  }
  return finished(video, file);
}

/// A bright square that moves over a gradient.
std::string written_motion(VideoContainer container) {
  constexpr std::uint32_t side = 64;
  const std::filesystem::path file = video_path();
  VideoFile video(file, {.width = side, .height = side, .fps = 30, .container = container});
  std::vector<std::uint8_t> rgba(4 * side * side, 255);
  for (std::uint32_t frame = 0; frame < 12; ++frame) {
    for (std::uint32_t i = 0; i < side * side; ++i) {
      const std::uint32_t x = i % side, y = i / side;
      const bool inside = x - 3 * frame < 20 && y - 2 * frame < 24;
      rgba[4 * i] = static_cast<std::uint8_t>(inside ? 240 - x : 2 * x);
      rgba[4 * i + 1] = static_cast<std::uint8_t>(inside ? 200 : 3 * y);
      rgba[4 * i + 2] = static_cast<std::uint8_t>(inside ? 60 : (x * y) / 16);
    }
    video.add({.width = side, .height = side, .rgba = rgba});
  }
  return finished(video, file);
}

TEST(VideoFile, AnMp4CanBePlayedFromItsBeginning) {
  const std::string bytes = written_video(VideoContainer::mp4, 24);
  EXPECT_EQ(bytes.substr(4, 4), "ftyp");
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
  EXPECT_NE(bytes.find("avc1"), std::string::npos);
}

TEST(VideoFile, TheSameFramesGiveTheSameBytes) {
  for (const VideoContainer container : {VideoContainer::mp4, VideoContainer::webm}) {
    EXPECT_EQ(written_video(container, 29.97), written_video(container, 29.97));
  }
}

// A process that has rendered other scenes has other memory than a new one.
TEST(VideoFile, BytesDoNotDependOnWhatMemoryHeldBefore) {
  for (const VideoContainer container : {VideoContainer::mp4, VideoContainer::webm}) {
    const std::string expected = written_motion(container);
    for (const int contents : {85, 170, 255}) {
      mallopt(M_PERTURB, contents);
      EXPECT_TRUE(written_motion(container) == expected) << contents;
    }
    mallopt(M_PERTURB, 0);
  }
}

TEST(VideoFile, AWebmHasItsKind) {
  const std::string bytes = written_video(VideoContainer::webm, 30);
  EXPECT_EQ(bytes.substr(0, 4), "\x1a\x45\xdf\xa3");
  EXPECT_NE(bytes.find("V_VP9"), std::string::npos);
}

TEST(VideoFile, WhatCannotBeWrittenIsTold) {
  EXPECT_THROW(
      VideoFile("/no/such/folder.mp4",
                {.width = width, .height = height, .fps = 30, .container = VideoContainer::mp4}),
      std::runtime_error);
}

TEST(Webp, KeepsAlphaWhereItIsAskedTo) {
  const auto image = plain_image(120);
  for (const Alpha alpha : {Alpha::ignored, Alpha::kept}) {
    const auto file = encode_webp(view_of(image), 90, alpha);
    int w = 0, h = 0;
    std::uint8_t* const decoded = WebPDecodeRGBA(file.data(), file.size(), &w, &h);
    ASSERT_NE(decoded, nullptr);
    EXPECT_EQ(std::pair(w, h), std::pair(int{width}, int{height}));
    EXPECT_NEAR(decoded[0], 120, 4);
    EXPECT_EQ(decoded[3], alpha == Alpha::kept ? 128 : 255);
    WebPFree(decoded);
  }
}

TEST(Webp, AnAnimationHasAllFramesInTime) {
  WebpAnimation animation(width, height, 25, 90, Alpha::ignored);
  for (int i = 0; i < frame_count; ++i) {
    const auto image = plain_image(static_cast<std::uint8_t>(40 * i));
    animation.add(view_of(image));
  }
  const auto file = animation.finish();
  const WebPData data{file.data(), file.size()};
  WebPAnimDecoder* const decoder = WebPAnimDecoderNew(&data, nullptr);
  ASSERT_NE(decoder, nullptr);
  std::uint8_t* rgba = nullptr;
  int frames = 0, time = 0;
  while (WebPAnimDecoderGetNext(decoder, &rgba, &time)) {
    EXPECT_NEAR(rgba[0], 40 * frames, 6);
    ++frames;
    EXPECT_EQ(time, 40 * frames) << "milliseconds, when the frame ends";
  }
  EXPECT_EQ(frames, frame_count);
  WebPAnimDecoderDelete(decoder);
}

}  // namespace
}  // namespace heliograph::stream
