#pragma once

#include <cstdint>
#include <vector>

#include "gpu/memory/buffer.hpp"
#include "shaders/shared/jpeg.h"

namespace heliograph::render {

/// The tables of ITU-T T.81 annex K, which libjpeg uses too, as shaders read them.
shared::JpegTables jpeg_tables();
gpu::Buffer make_jpeg_tables(const gpu::Device& device);

/// By how much the tables for quality 50 are scaled for a quality from 1 to 100, as libjpeg does.
std::uint32_t jpeg_percent(int quality);

/// A JPEG up to where the first restart interval of its coded image begins.
std::vector<std::uint8_t> jpeg_header(std::uint32_t width, std::uint32_t height, int quality);

}  // namespace heliograph::render
