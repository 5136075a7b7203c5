#include <algorithm>
#include <filesystem>
#include <string>

#include "jobs/job_queue.hpp"

namespace heliograph::jobs {
namespace {

using protocol::FileFormat;

std::string extension_of(FileFormat format) {
  if (format == FileFormat::jpeg) return ".jpg";
  if (format == FileFormat::animated_webp) return ".webp";
  return "." + std::string(protocol::enum_name(format));
}

std::string four_digits(std::size_t number) {
  std::string text = std::to_string(number);
  return std::string(4 - std::min<std::size_t>(4, text.size()), '0') + text;
}

}  // namespace

protocol::Result<std::string> checked_output(const protocol::RenderRequest& entry,
                                             std::size_t number, bool only_one) {
  if (entry.output.empty()) {
    const std::string prefix = only_one ? "" : four_digits(number) + "_";
    const std::string camera = entry.camera == "all" ? "_{camera}" : "";
    return prefix + "{scene}" + camera + extension_of(entry.format.value_or(FileFormat::png));
  }
  const std::filesystem::path path(entry.output);
  const bool leaves = std::ranges::any_of(
      path, [](const std::filesystem::path& element) { return element == ".."; });
  const bool hidden = entry.output.find('\0') != std::string::npos || entry.output == "-";
  if (path.is_absolute() || leaves || hidden) {
    return protocol::error::invalid("output", "must be the name of a file in the job");
  }
  return entry.output;
}

}  // namespace heliograph::jobs
