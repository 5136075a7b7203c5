#pragma once

#include <span>

#include "web_client/embedded_assets.hpp"

namespace heliograph::web {

/// Every file of the bundle; defined in a source that embed_assets.mjs generates.
std::span<const Asset> asset_table();

}  // namespace heliograph::web
