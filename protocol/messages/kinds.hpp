#pragma once

#include "protocol/json/enum_names.hpp"

namespace heliograph::protocol {

HELIOGRAPH_ENUM(DeviceType, cpu, integrated, discrete, virtual_, other)
HELIOGRAPH_ENUM(TracerKind, embree, software, ray_query, ray_pipeline)
HELIOGRAPH_ENUM(PassKind, device, host)
HELIOGRAPH_ENUM(UploadKind, scene, environment, image)
HELIOGRAPH_ENUM(ImageFormat, png, jpeg, webp, npy, exr)
/// What `heliograph render` and jobs write: the images, and files of many frames.
HELIOGRAPH_ENUM(FileFormat, png, jpeg, webp, npy, exr, mp4, webm, animated_webp)
HELIOGRAPH_ENUM(LightType, directional, point, spot, rectangle, disk)
HELIOGRAPH_ENUM(ControlMode, shared, exclusive)
HELIOGRAPH_ENUM(ViewerRole, view, control)
HELIOGRAPH_ENUM(ControlAction, take, give, release)

}  // namespace heliograph::protocol
