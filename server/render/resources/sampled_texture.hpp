#pragma once

#include <cstdint>
#include <span>

#include "gpu/memory/image.hpp"
#include "scene/scene.hpp"

namespace heliograph::render {

/// An image that samplers read, with all levels, which `pixels` are. `compressed`: where it comes
/// from a KTX2 file it is BC7, a quarter of RGBA8, unless that loses too much.
gpu::Image make_sampled_texture(const gpu::Device& device, const scene::Image& from,
                                std::span<const std::uint8_t> pixels, bool compressed);

}  // namespace heliograph::render
