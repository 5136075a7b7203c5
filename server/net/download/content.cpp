#include "net/download/content.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace heliograph::net {

void Content::add(std::string bytes) {
  const std::uint64_t size = bytes.size();
  segments_.push_back(
      {.bytes = std::move(bytes), .file = {}, .first = 0, .size = size, .owner = nullptr});
  size_ += size;
}

void Content::add_file(std::filesystem::path file, std::uint64_t size,
                       std::shared_ptr<const void> owner) {
  segments_.push_back(
      {.bytes = {}, .file = std::move(file), .first = 0, .size = size, .owner = std::move(owner)});
  size_ += size;
}

Content Content::part(std::uint64_t first, std::uint64_t size) const {
  Content part;
  for (const Segment& segment : segments_) {
    const std::uint64_t skipped = std::min(first, segment.size);
    const std::uint64_t taken = std::min(size, segment.size - skipped);
    first -= skipped;
    size -= taken;
    if (taken == 0) continue;
    Segment kept = segment;
    kept.size = taken;
    if (kept.file.empty()) {
      kept.bytes = segment.bytes.substr(skipped, taken);
    } else {
      kept.first += skipped;
    }
    part.size_ += taken;
    part.segments_.push_back(std::move(kept));
  }
  return part;
}

std::size_t ContentReader::read(std::span<char> to) {
  const auto& segments = content_->segments();
  while (segment_ < segments.size() && done_ == segments[segment_].size) {
    ++segment_;
    done_ = 0;
    file_ = {};
  }
  if (segment_ == segments.size()) return 0;
  const Content::Segment& segment = segments[segment_];
  const auto count =
      static_cast<std::size_t>(std::min<std::uint64_t>(to.size(), segment.size - done_));
  if (segment.file.empty()) {
    std::copy_n(segment.bytes.data() + done_, count, to.data());
  } else {
    if (done_ == 0) {
      file_.open(segment.file, std::ios::binary);
      file_.seekg(static_cast<std::streamoff>(segment.first));
    }
    if (!file_.read(to.data(), static_cast<std::streamsize>(count))) {
      throw std::runtime_error(segment.file.string() + " ended early");
    }
  }
  done_ += count;
  return count;
}

}  // namespace heliograph::net
