#include "tests/unit/scene/malformed/malformed.hpp"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <sstream>

namespace heliograph::scene::test {
namespace {

// Bounds for small files, with a wide margin. Seconds of CPU time, so that other load does not
// matter; sanitizers take several times as much time and memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(__clang__)
constexpr double max_seconds = 20.0;
constexpr std::uint64_t max_bytes = 1024ull << 20;
#else
constexpr double max_seconds = 2.0;
constexpr std::uint64_t max_bytes = 192ull << 20;
#endif

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::optional<std::uint64_t> read_status(std::string_view key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with(key)) continue;
    return std::stoull(line.substr(key.size() + 1)) * 1024;
  }
  return std::nullopt;
}

/// Peak resident memory, as the kernel reports it.
class PeakMemory {
 public:
  PeakMemory() {
    std::ofstream reset("/proc/self/clear_refs");
    reset << "5" << std::flush;
    if (reset) before_ = read_status("VmHWM");
  }
  std::optional<std::uint64_t> growth() const {
    const auto after = read_status("VmHWM");
    if (!before_ || !after) return std::nullopt;
    return *after - std::min(*after, *before_);
  }

 private:
  std::optional<std::uint64_t> before_;
};

bool is_one_printable_line(const std::string& text) {
  return !text.empty() && text.size() < 400 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
}

}  // namespace

std::string Malformed::import(const std::string& what, const std::filesystem::path& path) {
  const PeakMemory memory;
  const double start = processor_seconds();
  std::string refusal = refusal_of(path);
  const double elapsed = processor_seconds() - start;
  const auto growth = memory.growth();
  EXPECT_LT(elapsed, max_seconds) << what;
  EXPECT_LT(growth.value_or(0), max_bytes) << what;
  ++count_;
  worst_.seconds = std::max(worst_.seconds, elapsed);
  if (growth) worst_.bytes = std::max(worst_.bytes.value_or(0), *growth);
  return refusal;
}

void Malformed::expect_refused(const std::string& what, const GltfBuilder& document,
                               std::string_view place) {
  expect_refused(what, document.glb(), place);
}

void Malformed::expect_refused(const std::string& what, const Bytes& file, std::string_view place,
                               const char* name) {
  const std::string refusal = import(what, folder_.write(name, file));
  if (refusal.empty()) {
    ADD_FAILURE() << what << ": was accepted";
    return;
  }
  EXPECT_TRUE(is_one_printable_line(refusal)) << what << ": " << refusal;
  EXPECT_NE(refusal.find(place), std::string::npos) << what << ": " << refusal;
  EXPECT_EQ(refusal.find(folder_.path().string()), std::string::npos) << what << ": " << refusal;
}

void Malformed::expect_loaded(const std::string& what, const GltfBuilder& document) {
  EXPECT_EQ(import(what, folder_.write("scene.glb", document.glb())), "") << what;
}

void Malformed::expect_bounded(const std::string& what, const GltfBuilder& document) {
  import(what, folder_.write("scene.glb", document.glb()));
}

void Malformed::TearDown() {
  RecordProperty("files", count_);
  std::ostringstream line;
  line << count_ << " files, at most " << worst_.seconds * 1000.0 << " ms";
  if (worst_.bytes) line << " and " << double(*worst_.bytes >> 10) / 1024.0 << " MiB";
  std::cout << "             " << line.str() << "\n";
}

std::string named_in_errors(const std::string& json_pointer) {
  std::string result;
  std::istringstream parts(json_pointer.substr(1));
  for (std::string part; std::getline(parts, part, '/');) {
    if (std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; })) {
      result += "[" + part + "]";
    } else {
      result += (result.empty() ? "" : ".") + part;
    }
  }
  // Errors name an array of numbers, not its elements.
  static constexpr std::string_view lists[] = {"children", "joints",   "nodes",
                                               "variants", "children", "weights"};
  for (const std::string_view list : lists) {
    const std::size_t open = result.rfind('[');
    const bool last = open != std::string::npos && result.back() == ']';
    if (last && std::string_view(result).substr(0, open).ends_with("." + std::string(list))) {
      return result.substr(0, open);
    }
  }
  return result;
}

}  // namespace heliograph::scene::test
