#include "render/passes/jpeg/encode_jpeg.hpp"

#include <algorithm>
#include <cstring>

#include "protocol/messages/scaled_size.hpp"
#include "render/resources/tables/jpeg_tables.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

template <class Stage>
struct JpegCodeBindings {
  gpu::Read<Stage> shown;
  gpu::ReadBuffer<Stage, shared::JpegTables> tables;
  gpu::WriteBuffer<Stage, std::uint32_t> slots;
  gpu::WriteBuffer<Stage, std::uint32_t> lengths;
};
struct JpegCodeConstants {
  glm::uvec2 source;
  glm::uvec2 size;
  std::uint32_t mcus;
  std::uint32_t mcus_wide;
  std::uint32_t percent;
};

template <class Stage>
struct JpegPlaceBindings {
  gpu::ReadBuffer<Stage, std::uint32_t> lengths;
  gpu::WriteBuffer<Stage, std::uint32_t> places;
  gpu::WriteBuffer<Stage, std::uint32_t> report;
};

template <class Stage>
struct JpegJoinBindings {
  gpu::ReadBuffer<Stage, std::uint32_t> slots;
  gpu::ReadBuffer<Stage, std::uint32_t> lengths;
  gpu::ReadBuffer<Stage, std::uint32_t> places;
  gpu::WriteBuffer<Stage, std::uint32_t> joined;
  gpu::Read<Stage> shown;
};
struct JpegJoinConstants {
  glm::uvec2 size;
  std::uint32_t intervals;
};

constexpr std::uint32_t code_threads = 192;  // of each interval
constexpr std::uint32_t join_threads = 64;
constexpr std::uint32_t most_side = 65535;  // of a JPEG
constexpr std::uint64_t most_scaled_pixels = std::uint64_t{1} << 24;
constexpr std::uint32_t pixel_bytes = 3;  // of those that come in place of a JPEG

static_assert(pixel_bytes * shared::jpeg_interval_mcus * shared::jpeg_mcu_side *
                      shared::jpeg_mcu_side <
                  shared::jpeg_slot_words * sizeof(std::uint32_t),
              "pixels fit where their coded interval would be");

VkExtent2D encoded_size(VkExtent2D size, int percent) {
  return {protocol::scaled_side(size.width, percent), protocol::scaled_side(size.height, percent)};
}

VkExtent2D mcus_of(VkExtent2D size) {
  return gpu::FrameSize::squares(shared::jpeg_mcu_side).of(size);
}

std::uint32_t intervals_of(VkExtent2D size) {
  const VkExtent2D mcus = mcus_of(size);
  return (mcus.width * mcus.height + shared::jpeg_interval_mcus - 1) / shared::jpeg_interval_mcus;
}

std::uint64_t slot_words(std::uint32_t intervals) {
  return std::uint64_t{intervals} * shared::jpeg_slot_words;
}

}  // namespace

bool can_encode_jpeg(const gpu::Device& device, VkExtent2D size) {
  const std::uint32_t intervals = intervals_of(size);
  return size.width <= most_side && size.height <= most_side &&
         intervals <= device.limits().maxComputeWorkGroupCount[0] &&
         slot_words(intervals) * sizeof(std::uint32_t) <= device.limits().maxStorageBufferRange;
}

bool can_scale_jpeg(VkExtent2D size, int percent) {
  return percent == 100 || std::uint64_t{size.width} * size.height <= most_scaled_pixels;
}

EncodedOutput encode_jpeg(gpu::FramePlan& plan, const Programs& programs, const gpu::Buffer& tables,
                          gpu::ImageRef shown, VkExtent2D size,
                          const std::optional<JpegRequest>& request) {
  const auto program = [&programs](const gpu::ShaderBinary& shader) -> gpu::ProgramSource {
    return [&programs, &shader]() -> const gpu::ComputeProgram& {
      return programs.compute(shader, ~0u);
    };
  };
  const auto words = [&plan](const char* name, std::uint64_t count) {
    return plan.buffer(name, count * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                       gpu::Memory::device);
  };
  const auto returned_words = [&plan](const char* name, std::uint64_t count) {
    return plan.returned(name, count * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  };
  const std::uint32_t intervals = intervals_of(size);
  const gpu::BufferRef slots = words("jpeg.slots", slot_words(intervals));
  const gpu::BufferRef lengths = words("jpeg.lengths", intervals);
  const gpu::BufferRef places = words("jpeg.places", intervals + 1);
  const EncodedOutput encoded{size, returned_words("jpeg.length", 1),
                              returned_words("jpeg.joined", slot_words(intervals))};
  // Of a smaller image fewer workgroups do something.
  const auto used_intervals = [size, &request] {
    return intervals_of(encoded_size(size, request->percent));
  };
  plan.only_when(
      [&request] { return request.has_value(); },
      [&] {
        plan.pass("jpeg.code", program(shaders::jpeg_code))
            .bind<JpegCodeBindings>(
                {.shown = shown, .tables = plan.import(tables), .slots = slots, .lengths = lengths})
            .constants([size, &request] {
              const VkExtent2D made = encoded_size(size, request->percent);
              const VkExtent2D mcus = mcus_of(made);
              return JpegCodeConstants{{size.width, size.height},
                                       {made.width, made.height},
                                       mcus.width * mcus.height,
                                       mcus.width,
                                       jpeg_percent(request->quality)};
            })
            .dispatch({intervals * code_threads, 1});
        plan.pass("jpeg.place", program(shaders::jpeg_place))
            .bind<JpegPlaceBindings>(
                {.lengths = lengths, .places = places, .report = encoded.length})
            .constants(used_intervals)
            .dispatch({1, 1});
        plan.pass("jpeg.join", program(shaders::jpeg_join))
            .bind<JpegJoinBindings>({.slots = slots,
                                     .lengths = lengths,
                                     .places = places,
                                     .joined = encoded.joined,
                                     .shown = shown})
            .constants([size, used_intervals] {
              return JpegJoinConstants{{size.width, size.height}, used_intervals()};
            })
            .dispatch({intervals * join_threads, 1});
      });
  return encoded;
}

DeviceJpeg read_jpeg(const gpu::FramePlan& plan, const EncodedOutput& encoded,
                     const JpegRequest& made) {
  const VkExtent2D size = encoded_size(encoded.size, made.percent);
  DeviceJpeg jpeg{.made = made, .width = size.width, .height = size.height, .bytes = {}};
  std::uint32_t length = 0;
  std::memcpy(&length, plan.latest(encoded.length).mapped(), sizeof length);
  if (length == 0) return jpeg;
  const std::vector<std::uint8_t> header = jpeg_header(size.width, size.height, made.quality);
  const auto* const coded =
      reinterpret_cast<const std::uint8_t*>(plan.latest(encoded.joined).mapped());
  jpeg.bytes.reserve(header.size() + length);
  jpeg.bytes.assign(header.begin(), header.end());
  jpeg.bytes.insert(jpeg.bytes.end(), coded, coded + length);
  return jpeg;
}

std::vector<std::uint8_t> read_unencoded(const gpu::FramePlan& plan, const EncodedOutput& encoded) {
  const std::size_t pixels = std::size_t{encoded.size.width} * encoded.size.height;
  const auto* const rgb =
      reinterpret_cast<const std::uint8_t*>(plan.latest(encoded.joined).mapped());
  std::vector<std::uint8_t> rgba(4 * pixels, 255);
  for (std::size_t i = 0; i < pixels; ++i) {
    std::copy_n(rgb + pixel_bytes * i, pixel_bytes, rgba.data() + 4 * i);
  }
  return rgba;
}

}  // namespace heliograph::render
