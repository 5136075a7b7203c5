#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace heliograph::net {

/// What a response sends, of a size that is known before: bytes and parts of files, one after
/// another. Files are read while they are sent.
class Content {
 public:
  struct Segment {
    std::string bytes;           // if there is no file
    std::filesystem::path file;  // else this one's bytes
    std::uint64_t first = 0;     // of the file
    std::uint64_t size = 0;
    std::shared_ptr<const void> owner;  // of the file
  };

  void add(std::string bytes);
  /// `owner`: what keeps the file in existence, until it was sent.
  void add_file(std::filesystem::path file, std::uint64_t size,
                std::shared_ptr<const void> owner = nullptr);
  std::uint64_t size() const { return size_; }
  const std::vector<Segment>& segments() const { return segments_; }
  /// `size` bytes from `first` on, which must be there.
  Content part(std::uint64_t first, std::uint64_t size) const;

 private:
  std::vector<Segment> segments_;
  std::uint64_t size_ = 0;
};

class ContentReader {
 public:
  /// `content` lives longer.
  explicit ContentReader(const Content& content) : content_(&content) {}

  /// The next bytes; fewer than there is room for at the end of a segment, none at the very end.
  /// @throws std::runtime_error where a file ends early or cannot be read
  std::size_t read(std::span<char> to);

 private:
  const Content* content_;
  std::size_t segment_ = 0;
  std::uint64_t done_ = 0;  // of the segment
  std::ifstream file_;
};

}  // namespace heliograph::net
