#pragma once

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {

/// A small valid document with nearly all features of the importer: both kinds of camera, all kinds
/// of light, a skin, morph targets, sparse accessors, an animation, instances, variants, layered
/// materials and each kind of compression. Tests damage it; fuzzers use it as a seed.
GltfBuilder rich_document();

}  // namespace heliograph::scene::test
