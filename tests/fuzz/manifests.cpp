// Arbitrary bytes as a manifest must give entries, or a refusal of one line that names the file.
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "cli/render/manifest.hpp"
#include "input_file.hpp"
#include "protocol/json/codec.hpp"

using namespace heliograph;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// What was read must be an entry that a manifest may have.
void check_entry(const protocol::RenderRequest& entry) {
  const protocol::RawJson written = protocol::encode(entry);
  const auto again = protocol::decode<protocol::RenderRequest>(written);
  require(again.has_value());
  require(protocol::encode(*again) == written);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFile file("manifest.json");
  file.write(data, size);
  try {
    const auto entries = cli::read_manifest(file.path(), {.width = 640});
    require(!entries.empty());
    for (const protocol::RenderRequest& entry : entries) check_entry(entry);
  } catch (const std::invalid_argument& refusal) {
    const std::string_view what = refusal.what();
    require(what.starts_with(file.path().native()));
    require(what.find('\n') == std::string_view::npos);
  }
  return 0;
}
