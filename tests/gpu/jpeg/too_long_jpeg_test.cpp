// Frames whose JPEG does not fit into the memory that there is for it.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/api/renderer.hpp"
#include "render/passes/jpeg/encode_jpeg.hpp"
#include "render/resources/tables/jpeg_tables.hpp"
#include "tests/support/frame_rig.hpp"
#include "tests/support/similarity.hpp"

namespace heliograph::test {
namespace {

/// For intervals of at most so many bytes.
gpu::Buffer tables_with_room(const gpu::Device& device, std::uint32_t bytes) {
  shared::JpegTables tables = render::jpeg_tables();
  tables.most_interval_bytes = bytes;
  return gpu::upload_buffer(device, "jpeg.tables", std::as_bytes(std::span(&tables, 1)),
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
}

gpu::Buffer tables_without_room(const gpu::Device& device) {
  return tables_with_room(device, 0);
}

/// Of a file: behind the segment that begins its only scan, up to the marker of its end.
std::uint32_t coded_bytes(std::span<const std::uint8_t> file) {
  std::size_t at = 2;
  while (file[at + 1] != 0xda) at += 2u + file[at + 2] * 256u + file[at + 3];
  at += 2u + file[at + 2] * 256u + file[at + 3];
  return static_cast<std::uint32_t>(file.size() - 2 - at);
}

/// Opaque, each byte of a colour unlike its neighbours.
std::vector<std::uint8_t> distinct_pixels(VkExtent2D size) {
  std::vector<std::uint8_t> rgba;
  for (std::uint32_t i = 0; i < 4 * size.width * size.height; ++i) {
    rgba.push_back(i % 4 == 3 ? 255 : static_cast<std::uint8_t>(i * 37 % 251));
  }
  return rgba;
}

/// An image that the device has encoded with these tables.
struct EncodedImage {
  EncodedImage(VkExtent2D size, const std::vector<std::uint8_t>& rgba, const gpu::Buffer& tables,
               const render::JpegRequest& wanted)
      : request(wanted), plan(device(), size) {
    const gpu::ImageRef shown = plan.image("shown", VK_FORMAT_R8G8B8A8_UNORM);
    plan.get(shown).upload(std::as_bytes(std::span(rgba)));
    encoded = render::encode_jpeg(plan, engine().parts().programs, tables, shown, size, request);
    plan.compile();
    plan.execute();
  }
  std::vector<std::uint8_t> jpeg() const {
    return render::read_jpeg(plan, encoded, *request).bytes;
  }

  const std::optional<render::JpegRequest> request;  // which the plan refers to
  gpu::FramePlan plan;
  render::EncodedOutput encoded;
};

TEST(TooLongJpeg, LeavesThePixelsOfTheWholeImage) {
  const struct {
    VkExtent2D size;
    int percent;
  } cases[]{{{1, 1}, 100},   {{3, 1}, 100},    {{7, 5}, 100},
            {{64, 16}, 100}, {{133, 71}, 100}, {{133, 71}, 50}};
  const gpu::Buffer tables = tables_without_room(device());
  for (const auto& [size, percent] : cases) {
    SCOPED_TRACE(std::to_string(size.width) + "x" + std::to_string(size.height) + " to " +
                 std::to_string(percent));
    const std::vector<std::uint8_t> rgba = distinct_pixels(size);
    const EncodedImage image(size, rgba, tables, {.quality = 80, .percent = percent});
    EXPECT_TRUE(image.jpeg().empty());
    EXPECT_EQ(render::read_unencoded(image.plan, image.encoded), rgba);
  }
}

TEST(TooLongJpeg, IsOneWhoseIntervalIsAByteLongerThanThereIsRoomFor) {
  const VkExtent2D size{64, 16};  // one interval
  const std::vector<std::uint8_t> rgba = distinct_pixels(size);
  const auto encode = [&](const gpu::Buffer& tables) {
    return EncodedImage(size, rgba, tables, {.quality = 95}).jpeg();
  };
  const auto file = encode(render::make_jpeg_tables(device()));
  const std::uint32_t length = coded_bytes(file);
  ASSERT_GT(length, 500u);
  EXPECT_EQ(encode(tables_with_room(device(), length)), file);
  EXPECT_TRUE(encode(tables_with_room(device(), length - 1)).empty());
}

/// Frames of an engine that encodes, as on a GPU, and none of whose JPEGs fits.
class TooLongJpegFrames : public testing::Test {
 protected:
  TooLongJpegFrames()
      : engine_(render::EngineOptions{.device = device().report().name,
                                      .validation = true,
                                      .as_gpu = true,
                                      .jpeg = render::JpegEncoding::on}) {
    gpu::Buffer& tables = engine_.parts().jpeg_tables;
    tables = tables_without_room(engine_.parts().device);
    SceneBuilder scene;
    scene.place(scene.add_sphere(0.8f, surface({0.9f, 0.3f, 0.2f}, 0.5f)));
    scene.add_sun({0.3f, -0.5f, -1.0f}, {3, 2, 1}, 0.01f);
    scene_ =
        engine_.upload(scene.build(), heliograph::scene::constant_environment(glm::vec3(0.5f)));
  }
  void TearDown() override { EXPECT_EQ(engine_.validation_messages(), 0u); }

  /// A frame of the sphere on the left and the next, with the sphere on the right. `together`: that
  /// one begins before the first is finished.
  std::array<render::Frame, 2> render_both(const std::optional<render::JpegRequest>& request,
                                           bool together) {
    render::Renderer renderer(engine_);
    protocol::Settings settings = without_indirect();
    settings.specular.enabled = false;
    settings.ambient.occlusion = false;
    EXPECT_TRUE(renderer.set_settings(settings));
    renderer.keep_buffers(false);
    renderer.set_size(97, 53);
    renderer.set_scene(scene_);
    renderer.request_jpeg(request);
    renderer.set_camera(look({0.8f, 0.4f, 3}, {0.8f, 0, 0}));
    for (int i = 0; i < 3; ++i) renderer.render();
    std::array<render::Frame, 2> frames;
    EXPECT_TRUE(renderer.begin({}));
    if (together) {
      EXPECT_TRUE(renderer.can_begin_another());
    } else {
      frames[0] = renderer.finish();
    }
    renderer.set_camera(look({-0.8f, 0.4f, 3}, {-0.8f, 0, 0}));
    EXPECT_TRUE(renderer.begin({}));
    if (together) frames[0] = renderer.finish();
    frames[1] = renderer.finish();
    return frames;
  }

  render::Engine engine_;
  std::shared_ptr<const render::SceneResources> scene_;
};

TEST_F(TooLongJpegFrames, ComeWithTheirOwnPixelsWhileTheNextIsDrawn) {
  const auto expected = render_both(std::nullopt, false);
  ASSERT_GT(difference(expected[0], expected[1]).mean, 1.0);
  const render::JpegRequest whole{.quality = 80}, half{.quality = 80, .percent = 50};
  for (const render::JpegRequest& request : {whole, half}) {
    for (const bool together : {false, true}) {
      SCOPED_TRACE(std::to_string(request.percent) + (together ? "% together" : "%"));
      const auto frames = render_both(request, together);
      for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_TRUE(frames[i].jpeg.bytes.empty());
        ASSERT_EQ(frames[i].rgba.size(), expected[i].rgba.size());
        EXPECT_LT(difference(frames[i], expected[i]).mean, 0.1) << "frame " << i;
      }
    }
  }
}

}  // namespace
}  // namespace heliograph::test
