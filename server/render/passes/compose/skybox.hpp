#pragma once

#include <functional>
#include <memory>

#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/resources/environment/background.hpp"
#include "render/resources/host_tables.hpp"

namespace heliograph::render {

inline constexpr struct SkyboxBuffers {
  BufferDescription radiance{"skybox", ViewColors::radiance,
                             "Radiance of the background behind the scene."};
} skybox_buffers{};

/// What the camera sees where nothing is, in the frames of one plan. The inputs' scene outlives it.
class SeenBackground {
 public:
  explicit SeenBackground(const FrameInputs& in);
  kernels::RadianceMap map() const;

 private:
  std::shared_ptr<const Background> chosen_;  // null: the environment
  const MovingScene& moving_;
};

/// Linear radiance of the background where no surface was drawn; elsewhere black.
/// @param when  frames that need it; empty: all do
gpu::ImageRef draw_skybox(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                          const std::function<bool()>& when = {});

}  // namespace heliograph::render
