#include "scene/confined_folder.hpp"

#include <algorithm>

#include "scene/import_error.hpp"
#include "scene/quote.hpp"
#include "scene/regular_file.hpp"

namespace heliograph::scene {
namespace {

bool is_inside(const std::filesystem::path& path, const std::filesystem::path& root) {
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

}  // namespace

ConfinedFolder::ConfinedFolder(const std::filesystem::path& folder, std::uint64_t byte_budget)
    : budget_(byte_budget) {
  std::error_code error;
  root_ = std::filesystem::canonical(folder.empty() ? "." : folder, error);
  if (error) throw ImportError("the scene's folder cannot be opened");
}

std::filesystem::path ConfinedFolder::resolve(const std::string& relative) const {
  const std::string label = in_quotes(relative);
  const auto outside = [&] { throw ImportError(label + " is outside the scene's folder"); };
  if (relative.find('\0') != std::string::npos)
    throw ImportError("a file name contains a zero byte");
  const std::filesystem::path requested(relative);
  if (requested.is_absolute() || !is_inside((root_ / requested).lexically_normal(), root_))
    outside();
  if (root_.empty()) throw MissingFile(label + " is missing");
  std::error_code error;
  const std::filesystem::path resolved = std::filesystem::canonical(root_ / requested, error);
  if (error) throw MissingFile(label + " is missing");
  if (!is_inside(resolved, root_)) outside();
  return resolved;
}

std::uint64_t ConfinedFolder::size_of(const std::string& relative) const {
  return examine_file(resolve(relative)).bytes;
}

std::vector<std::uint8_t> ConfinedFolder::read(const std::string& relative,
                                               const std::stop_token& stop) {
  const std::filesystem::path resolved = resolve(relative);
  files_.push_back(examine_file(resolved));
  std::vector<std::uint8_t> bytes = read_regular_file(resolved, budget_, in_quotes(relative), stop);
  budget_ -= bytes.size();
  return bytes;
}

std::vector<std::uint8_t> read_regular_file(const std::filesystem::path& path,
                                            std::uint64_t max_bytes, const std::string& label,
                                            const std::stop_token& stop) {
  return read_all(RegularFile(path, max_bytes, label), stop);
}

}  // namespace heliograph::scene
