#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gpu/frame_plan/frame_plan.hpp"
#include "render/api/frame_values.hpp"
#include "render/resources/programs.hpp"

namespace heliograph::render {

/// What the device makes of a frame for the host.
struct EncodedOutput {
  VkExtent2D size;        // of the frame
  gpu::BufferRef length;  // of the coded image, bytes; 0: it does not fit
  gpu::BufferRef joined;  // the coded image; where it does not fit, the frame's pixels
};

/// Whether images of this size can be encoded.
bool can_encode_jpeg(const gpu::Device& device, VkExtent2D size);
/// Whether they can be made smaller for that, to so many percent of width and height: where the
/// sums of all pixels of an area are exact.
bool can_scale_jpeg(VkExtent2D size, int percent);

/// Encodes `shown`, RGBA8 of `size`, in frames where there is a request: the image that libjpeg
/// makes with chroma at half the size, its accurate DCT and restart intervals. Where one of those
/// is too long, the pixels of `shown` come to the host in place of it. `tables` are those of
/// make_jpeg_tables(). All references outlive the plan.
EncodedOutput encode_jpeg(gpu::FramePlan& plan, const Programs& programs, const gpu::Buffer& tables,
                          gpu::ImageRef shown, VkExtent2D size,
                          const std::optional<JpegRequest>& request);

/// The file of the frame that was finished last, `made` so; without bytes where it was too long.
DeviceJpeg read_jpeg(const gpu::FramePlan& plan, const EncodedOutput& encoded,
                     const JpegRequest& made);
/// The pixels of the frame that was finished last, where its JPEG was too long: RGBA, alpha 255,
/// row 0 on top, whatever is drawn into its image by now.
std::vector<std::uint8_t> read_unencoded(const gpu::FramePlan& plan, const EncodedOutput& encoded);

}  // namespace heliograph::render
