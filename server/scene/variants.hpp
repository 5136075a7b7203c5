#pragma once

#include <string>
#include <vector>

#include "scene/json_value.hpp"

namespace heliograph::scene {

/// The names of KHR_materials_variants, in the document's order, with every mapping of a primitive
/// to one of them checked. What is shown is the materials outside the extension.
/// @throws ImportError
std::vector<std::string> read_variants(const JsonValue& root, std::size_t material_count);

}  // namespace heliograph::scene
