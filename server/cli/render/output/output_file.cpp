#include "cli/render/output/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "stream/encoders/webp_encoder.hpp"
#include "stream/video/video_file.hpp"

namespace heliograph::cli {
namespace {

namespace fs = std::filesystem;
using protocol::FileFormat;

constexpr int animation_quality = 80;

/// The name of a file that is not complete yet, beside it.
fs::path partial_name(fs::path file) {
  file += ".part";
  return file;
}

/// A file that gets its name when it is complete. Devices and pipes have no other.
class PartialFile {
 public:
  explicit PartialFile(fs::path file) : file_(std::move(file)), name_(file_) {
    std::error_code ignored;
    const bool special = fs::exists(file_, ignored) && !fs::is_regular_file(file_, ignored);
    if (!special) name_ = partial_name(file_);
  }
  ~PartialFile() {
    std::error_code ignored;
    if (name_ != file_ && !finished_) fs::remove(name_, ignored);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  const fs::path& name() const { return name_; }
  void finish() {
    if (name_ != file_) fs::rename(name_, file_);
    finished_ = true;
  }

 private:
  const fs::path file_;
  fs::path name_;
  bool finished_ = false;
};

void write_to_standard_output(const std::vector<std::uint8_t>& bytes) {
  const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
  if (!whole || std::fflush(stdout) != 0) {
    throw std::runtime_error("cannot write to standard output");
  }
}

const render::Frame& frame_of(const session::CaptureContent& content) {
  return std::get<render::Frame>(content.values);
}

stream::ImageView view_of(const render::Frame& frame) {
  return {.width = frame.width, .height = frame.height, .rgba = frame.rgba};
}

class ImageFile : public OutputFile {
 public:
  ImageFile(fs::path file, const OutputFormat& format) : file_(std::move(file)), format_(format) {}

  void add(const session::CaptureContent& content) override {
    bytes_ = session::encode_content(content, read_format(format_.format), format_.alpha);
  }
  void finish() override { write_whole(file_, bytes_); }

 private:
  const fs::path file_;
  const OutputFormat format_;
  std::vector<std::uint8_t> bytes_;
};

class AnimatedImage : public OutputFile {
 public:
  AnimatedImage(fs::path file, const OutputFormat& format)
      : file_(std::move(file)), format_(format) {}

  void add(const session::CaptureContent& content) override {
    const render::Frame& frame = frame_of(content);
    if (!animation_) {
      animation_.emplace(frame.width, frame.height, format_.fps, animation_quality, format_.alpha);
    }
    animation_->add(view_of(frame));
  }
  void finish() override { write_whole(file_, animation_->finish()); }

 private:
  const fs::path file_;
  const OutputFormat format_;
  std::optional<stream::WebpAnimation> animation_;
};

class Video : public OutputFile {
 public:
  Video(const fs::path& file, const OutputFormat& format) : file_(file), format_(format) {}

  void add(const session::CaptureContent& content) override {
    const render::Frame& frame = frame_of(content);
    if (!video_) {
      const auto container = format_.format == FileFormat::mp4 ? stream::VideoContainer::mp4
                                                               : stream::VideoContainer::webm;
      video_ = std::make_unique<stream::VideoFile>(
          file_.name(), stream::VideoFile::Options{.width = frame.width,
                                                   .height = frame.height,
                                                   .fps = format_.fps,
                                                   .container = container});
    }
    video_->add(view_of(frame));
  }
  void finish() override {
    video_->finish();
    file_.finish();
  }

 private:
  PartialFile file_;
  const OutputFormat format_;
  std::unique_ptr<stream::VideoFile> video_;
};

}  // namespace

bool can_write(const fs::path& file) {
  std::error_code ignored;
  const bool existed = fs::exists(file, ignored);
  if (existed && !fs::is_regular_file(file, ignored)) return !fs::is_directory(file, ignored);
  if (!file.parent_path().empty()) fs::create_directories(file.parent_path(), ignored);
  // A renderer that is killed here must not leave an empty file of that name: resuming would keep
  // it.
  const fs::path tried = existed ? file : partial_name(file);
  const bool opened = std::ofstream(tried, std::ios::app).is_open();
  if (opened && !existed) fs::remove(tried, ignored);
  return opened;
}

void write_whole(const fs::path& path, const std::vector<std::uint8_t>& bytes) {
  if (path.empty()) return write_to_standard_output(bytes);
  write_whole(path, [&](std::ostream& file) {
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  });
}

void write_whole(const fs::path& path, const std::function<void(std::ostream& file)>& write) {
  PartialFile partial(path);
  errno = 0;
  std::ofstream file(partial.name(), std::ios::binary);
  write(file);
  file.close();
  if (!file) {
    const std::string why = errno == 0 ? "" : std::string(": ") + std::strerror(errno);
    throw std::runtime_error("cannot write " + path.string() + why);
  }
  partial.finish();
}

protocol::ImageFormat read_format(FileFormat format) {
  switch (format) {
    case FileFormat::png:
      return protocol::ImageFormat::png;
    case FileFormat::jpeg:
      return protocol::ImageFormat::jpeg;
    case FileFormat::npy:
      return protocol::ImageFormat::npy;
    case FileFormat::exr:
      return protocol::ImageFormat::exr;
    case FileFormat::webp:
    case FileFormat::mp4:
    case FileFormat::webm:
    case FileFormat::animated_webp:
      return protocol::ImageFormat::webp;
  }
  return protocol::ImageFormat::png;
}

std::unique_ptr<OutputFile> open_output(const fs::path& path, const OutputFormat& format) {
  switch (format.format) {
    case FileFormat::mp4:
    case FileFormat::webm:
      return std::make_unique<Video>(path, format);
    case FileFormat::animated_webp:
      return std::make_unique<AnimatedImage>(path, format);
    default:
      return std::make_unique<ImageFile>(path, format);
  }
}

}  // namespace heliograph::cli
