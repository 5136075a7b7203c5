// Replaces video_file.cpp in builds without libavformat.
#include <stdexcept>

#include "stream/video/video_file.hpp"

namespace heliograph::stream {

struct VideoFile::State {};

VideoFile::VideoFile(const std::filesystem::path&, const Options&) {
  throw std::runtime_error("this program was built without videos");
}

VideoFile::~VideoFile() = default;

void VideoFile::add(const ImageView&) {}

void VideoFile::finish() {}

}  // namespace heliograph::stream
