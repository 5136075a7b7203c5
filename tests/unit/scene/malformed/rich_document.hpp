#pragma once

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {

/// A small valid document that has nearly everything an importer reads: both kinds of camera, all
/// kinds of light, a skin, morph targets, sparse values, an animation, instances, variants, layered
/// materials, and each kind of compression. Tests damage it, fuzzers begin with it.
GltfBuilder rich_document();

}  // namespace heliograph::scene::test
