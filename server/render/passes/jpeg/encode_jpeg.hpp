#pragma once

#include <cstdint>
#include <vector>

#include "gpu/frame_plan/frame_plan.hpp"
#include "render/resources/programs.hpp"

namespace heliograph::render {

/// What the device makes of a frame for the host.
struct EncodedOutput {
  VkExtent2D size;
  gpu::BufferRef length;  // of the coded image, bytes; 0: it does not fit
  gpu::BufferRef joined;  // the coded image
};

/// Whether images of this size can be encoded.
bool can_encode_jpeg(const gpu::Device& device, VkExtent2D size);

/// Encodes `shown`, RGBA8 of `size`, in frames where `quality` is 1 to 100: the image that libjpeg
/// makes with chroma at half the size, its accurate DCT and restart intervals. `tables` are those
/// of make_jpeg_tables(). All references outlive the plan.
EncodedOutput encode_jpeg(gpu::FramePlan& plan, const Programs& programs, const gpu::Buffer& tables,
                          gpu::ImageRef shown, VkExtent2D size, const int& quality);

/// The file of the frame that was finished last, encoded at `quality`; empty where it was too long.
std::vector<std::uint8_t> read_jpeg(const gpu::FramePlan& plan, const EncodedOutput& encoded,
                                    int quality);

}  // namespace heliograph::render
