#include "render/passes/jpeg/encode_jpeg.hpp"

#include <cstring>

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
};

constexpr std::uint32_t code_threads = 192;  // of each interval
constexpr std::uint32_t join_threads = 64;
constexpr std::uint32_t most_side = 65535;  // of a JPEG

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

EncodedOutput encode_jpeg(gpu::FramePlan& plan, const Programs& programs, const gpu::Buffer& tables,
                          gpu::ImageRef shown, VkExtent2D size, const int& quality) {
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
  plan.only_when(
      [&quality] { return quality > 0; },
      [&] {
        plan.pass("jpeg.code", program(shaders::jpeg_code))
            .bind<JpegCodeBindings>(
                {.shown = shown, .tables = plan.import(tables), .slots = slots, .lengths = lengths})
            .constants([size, &quality] {
              const VkExtent2D mcus = mcus_of(size);
              return JpegCodeConstants{{size.width, size.height},
                                       mcus.width * mcus.height,
                                       mcus.width,
                                       jpeg_percent(quality)};
            })
            .dispatch({intervals * code_threads, 1});
        plan.pass("jpeg.place", program(shaders::jpeg_place))
            .bind<JpegPlaceBindings>(
                {.lengths = lengths, .places = places, .report = encoded.length})
            .constants(intervals)
            .dispatch({1, 1});
        plan.pass("jpeg.join", program(shaders::jpeg_join))
            .bind<JpegJoinBindings>(
                {.slots = slots, .lengths = lengths, .places = places, .joined = encoded.joined})
            .constants(intervals)
            .dispatch({intervals * join_threads, 1});
      });
  return encoded;
}

std::vector<std::uint8_t> read_jpeg(const gpu::FramePlan& plan, const EncodedOutput& encoded,
                                    int quality) {
  std::uint32_t length = 0;
  std::memcpy(&length, plan.latest(encoded.length).mapped(), sizeof length);
  if (length == 0) return {};
  std::vector<std::uint8_t> file = jpeg_header(encoded.size.width, encoded.size.height, quality);
  const auto* const coded =
      reinterpret_cast<const std::uint8_t*>(plan.latest(encoded.joined).mapped());
  file.insert(file.end(), coded, coded + length);
  return file;
}

}  // namespace heliograph::render
