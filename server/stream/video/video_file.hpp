#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// H.264 in MP4, or VP9 in WebM.
enum class VideoContainer { mp4, webm };

/// Writes a video file: 4:2:0, BT.709, limited range. An odd last column or row is cropped.
class VideoFile {
 public:
  struct Options {
    std::uint32_t width;
    std::uint32_t height;
    double fps;
    VideoContainer container;
  };

  /// @throws std::runtime_error if the file cannot be written or there is no such encoder
  VideoFile(const std::filesystem::path& file, const Options& options);
  /// A file that was not finished cannot be played.
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  /// @throws std::runtime_error, also if the image has another size
  void add(const ImageView& image);
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::stream
