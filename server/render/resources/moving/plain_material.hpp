#pragma once

#include "shaders/shared/scene.h"

namespace heliograph::render {

/// The grey, rough material that stands for any other where only shapes are shown; holes and the
/// number of sides stay.
shared::Material plain_material(const shared::Material& material);

}  // namespace heliograph::render
