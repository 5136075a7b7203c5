// Where the surfaces of a frame are, coarsely, for clients that show it from another camera.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/frame/renderer_state.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {
namespace {

/// Pixels of the finished frame along a side of a sample.
constexpr std::uint32_t depth_sample_side = 5;
/// Texels that are read along each side of a sample, at most.
constexpr std::uint32_t most_depth_reads = 4;
/// A sample whose surfaces are farther apart than this part of the nearer one shows an edge.
constexpr float depth_edge = 0.04f;

/// The size of a plane that covers a frame of this size.
VkExtent2D depth_plane_size(VkExtent2D frame) {
  for (std::uint32_t side = depth_sample_side;; ++side) {
    const VkExtent2D size{(frame.width + side - 1) / side, (frame.height + side - 1) / side};
    if (std::size_t{size.width} * size.height <= protocol::max_depth_samples) return size;
  }
}

/// The texel of `texels` that read `i` of `reads`, which are spread evenly, finds.
std::uint32_t depth_texel(std::uint32_t i, std::uint32_t reads, std::uint32_t texels) {
  const std::uint64_t middle = (2 * std::uint64_t{i} + 1) * texels / (2 * std::uint64_t{reads});
  return static_cast<std::uint32_t>(middle);
}

/// Rows of the image of motion vectors, whose last channel is the distance along the view. Without
/// access of the host, only those rows are copied that are read.
class DepthRows {
 public:
  DepthRows(const gpu::Device& device, const CompiledFrame::DrawnImage& motion, std::uint32_t count)
      : motion_(motion), count_(count) {
    if (motion.whole.host()) return;
    const VkDeviceSize pitch = row_bytes();
    copy_ = gpu::Buffer(device, "depth rows", pitch * count, 0, gpu::Memory::readback);
    device.submit_once([&](VkCommandBuffer commands) {
      gpu::full_barrier(commands);
      for (std::uint32_t i = 0; i < count; ++i) {
        VkBufferImageCopy region{};
        region.bufferOffset = pitch * i;
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageOffset.y =
            static_cast<std::int32_t>(depth_texel(i, count, motion.drawn.height));
        region.imageExtent = {motion.drawn.width, 1, 1};
        vkCmdCopyImageToBuffer(commands, motion.whole.handle(), VK_IMAGE_LAYOUT_GENERAL,
                               copy_.handle(), 1, &region);
      }
      gpu::full_barrier(commands);
    });
  }

  /// Metres; 0: no surface.
  float view_z(std::uint32_t row, std::uint32_t x) const {
    const gpu::HostView host = motion_.whole.host();
    const std::byte* const bytes =
        host ? host.data + host.row_pitch * depth_texel(row, count_, motion_.drawn.height)
             : copy_.mapped() + row_bytes() * row;
    float value;
    std::memcpy(&value, bytes + (std::size_t{x} * 4 + 3) * sizeof(float), sizeof value);
    return value;
  }

 private:
  std::size_t row_bytes() const { return std::size_t{motion_.drawn.width} * 4 * sizeof(float); }

  const CompiledFrame::DrawnImage motion_;
  const std::uint32_t count_;
  gpu::Buffer copy_;
};

/// The plane that catches shadows, where the background shows it.
class GroundDepth {
 public:
  GroundDepth(const shared::FrameConstants& frame, VkExtent2D samples)
      : frame_(frame), scale_(2.0f / glm::vec2(samples.width, samples.height)) {}

  /// 1 / distance along the view in the middle of a sample; 0: it is not seen there.
  float inverse(std::uint32_t x, std::uint32_t y) const {
    const glm::vec4& ground = frame_.ground;
    if (ground.w <= 0.0f || frame_.eye.y <= ground.y) return 0.0f;
    const glm::vec4& u = frame_.unproject;
    const glm::vec2 ndc = (glm::vec2(x, y) + 0.5f) * scale_ - 1.0f;
    const glm::vec3 direction = glm::mat3(frame_.inverse_view) *
                                glm::vec3(ndc * glm::vec2(u.x, u.y), -1.0f);  // view Z changes by 1
    if (direction.y >= 0.0f) return 0.0f;
    const float view_z = (ground.y - frame_.eye.y) / direction.y;
    const glm::vec3 met = glm::vec3(frame_.eye) + view_z * direction;
    const float from_middle = glm::length(glm::vec2(met.x - ground.x, met.z - ground.z));
    return from_middle < ground.w ? 1.0f / view_z : 0.0f;
  }

 private:
  const shared::FrameConstants& frame_;
  glm::vec2 scale_;
};

/// 1 / distance for each sample; 0: the background. Where a sample shows an edge, the nearer
/// surface counts: it keeps its shape when it is moved.
std::vector<float> inverse_depths(const DepthRows& rows, const GroundDepth& ground, VkExtent2D size,
                                  std::uint32_t width, std::uint32_t reads) {
  std::vector<float> inverse;
  inverse.reserve(std::size_t{size.width} * size.height);
  for (std::uint32_t y = 0; y < size.height; ++y) {
    for (std::uint32_t x = 0; x < size.width; ++x) {
      float least = INFINITY, most = 0.0f, sum = 0.0f;
      const float behind = ground.inverse(x, y);
      for (std::uint32_t i = 0; i < reads * reads; ++i) {
        const std::uint32_t column = x * reads + i % reads;
        const float z =
            rows.view_z(y * reads + i / reads, depth_texel(column, size.width * reads, width));
        const float value = z > 0.0f && std::isfinite(z) ? 1.0f / z : behind;
        least = std::min(least, value);
        most = std::max(most, value);
        sum += value;
      }
      const bool edge = most - least > depth_edge * most;
      inverse.push_back(edge ? most : sum / static_cast<float>(reads * reads));
    }
  }
  return inverse;
}

}  // namespace

std::optional<protocol::FrameDepth> Renderer::depth() const {
  const scene::Camera& camera = state_->camera;
  if (!state_->compiled || camera.orthographic_height > 0.0f) return std::nullopt;
  const auto motion = state_->compiled->find(gbuffer_buffers.motion.name);
  if (!motion) return std::nullopt;
  const VkExtent2D size = depth_plane_size(state_->extent);
  const std::uint32_t width = motion->drawn.width;
  const std::uint32_t reads = std::clamp(width / size.width, 1u, most_depth_reads);
  const DepthRows rows(state_->parts.device, *motion, size.height * reads);
  const GroundDepth ground(state_->constants, size);
  const std::vector<float> inverse = inverse_depths(rows, ground, size, width, reads);
  const float most = std::ranges::max(inverse);

  protocol::FrameDepth depth{.width = static_cast<std::uint16_t>(size.width),
                             .height = static_cast<std::uint16_t>(size.height),
                             .nearest = most > 0.0f ? 1.0f / most : 1.0f,
                             .eye = {camera.eye.x, camera.eye.y, camera.eye.z},
                             .target = {camera.target.x, camera.target.y, camera.target.z},
                             .up = {camera.up.x, camera.up.y, camera.up.z},
                             .vertical_fov = camera.vertical_fov};
  depth.samples.reserve(inverse.size());
  for (const float value : inverse) {
    const float share = std::ceil(65535.0f * value * depth.nearest);
    depth.samples.push_back(static_cast<std::uint16_t>(std::min(share, 65535.0f)));
  }
  return depth;
}

}  // namespace heliograph::render
