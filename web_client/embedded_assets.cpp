#include "web_client/embedded_assets.hpp"

#include <algorithm>

#include "web_client/asset_table.hpp"

namespace heliograph::web {

const Asset* find_asset(std::string_view path) {
  if (path.starts_with('/')) path.remove_prefix(1);
  if (path.empty()) path = "index.html";
  const std::span<const Asset> assets = asset_table();
  const auto found = std::ranges::find(assets, path, &Asset::path);
  return found == assets.end() ? nullptr : &*found;
}

}  // namespace heliograph::web
