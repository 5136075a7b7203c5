#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <vector>

#include "protocol/messages/kinds.hpp"
#include "session/rendering/capture_content.hpp"
#include "stream/encoders/image_view.hpp"

namespace heliograph::cli {

/// Whether the file can be written, in a folder that is made where it is missing; a file that does
/// not exist does not exist afterwards either.
bool can_write(const std::filesystem::path& file);

/// Writes a file as a whole: it has the name only when it is complete. An empty path is standard
/// output. @throws std::runtime_error
void write_whole(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes);
/// The same of a file, not standard output, that `write` writes. @throws what `write` throws, too
void write_whole(const std::filesystem::path& path,
                 const std::function<void(std::ostream& file)>& write);

/// The file of an image, or of all frames of a video.
class OutputFile {
 public:
  virtual ~OutputFile() = default;
  /// @throws std::runtime_error
  virtual void add(const session::CaptureContent& content) = 0;
  /// Gives the file its name.
  virtual void finish() = 0;
};

struct OutputFormat {
  protocol::FileFormat format;
  double fps;
  stream::Alpha alpha;
};

/// What a renderer has to read for files of this format.
protocol::ImageFormat read_format(protocol::FileFormat format);

/// @throws std::runtime_error
std::unique_ptr<OutputFile> open_output(const std::filesystem::path& path,
                                        const OutputFormat& format);

}  // namespace heliograph::cli
