#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "gpu/frame_plan/frame_plan.hpp"
#include "tests/gpu/embedded.hpp"
#include "tests/support/engine.hpp"

namespace heliograph::gpu {

/// A plan of small images and a shader that adds (add.comp).
class FramePlanTest : public testing::Test {
 protected:
  static constexpr VkFormat format = VK_FORMAT_R32_SFLOAT;

  /// One pass `name`: to = from + amount.
  PassBuilder add(const std::string& name, ImageRef from, ImageRef to, float amount = 1.0f) {
    return plan_.pass(name, program_)
        .read(from)
        .write(to)
        .constants(amount)
        .dispatch(plan_.extent());
  }
  ImageRef image(const std::string& name) {
    const ImageRef made = plan_.image(name, format);
    plan_.get(made).clear();
    return made;
  }
  float value(ImageRef image) {
    const auto bytes = plan_.latest(image).download();
    const auto* texels = reinterpret_cast<const float*>(bytes.data());
    for (std::size_t i = 1; i < bytes.size() / 4; ++i) EXPECT_EQ(texels[i], texels[0]) << i;
    return texels[0];
  }
  /// The error of compile().
  std::string complaint() {
    try {
      plan_.compile();
    } catch (const GpuError& error) {
      return error.what();
    }
    return {};
  }
  void expect_complaint(std::initializer_list<const char*> parts) {
    const std::string text = complaint();
    for (const char* part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << part << ": " << text;
  }

  const Device& device_ = test::device();
  ComputeProgram program_{device_, test::shaders::add};
  FramePlan plan_{device_, {13, 9}};
};

}  // namespace heliograph::gpu
