#pragma once

#include <cstddef>
#include <cstdint>

// Limits that messages, settings, the command line and HTTP parameters share. Both ends of a range
// are allowed.

namespace heliograph::protocol {

/// Samples per pixel of a capture, a reference image or a converged frame.
inline constexpr std::uint32_t max_samples_per_pixel = 65536;

/// Width and height of rendered frames, pixels.
inline constexpr std::uint32_t min_frame_size = 16;
inline constexpr std::uint32_t max_frame_size = 16384;

/// Quality of encoded frames on the scale of JPEG.
inline constexpr int min_quality = 1;
inline constexpr int max_quality = 100;

/// Frame rate of a stream, frames per second.
inline constexpr double min_frame_rate = 0.1;
inline constexpr double max_frame_rate = 240.0;

/// Distance from the origin along each axis of cameras, their targets and lights; metres.
inline constexpr float max_coordinate = 1e9f;

/// Vertical field of view of cameras, degrees.
inline constexpr float min_field_of_view = 1.0f;
inline constexpr float max_field_of_view = 170.0f;

/// Nodes of a scene in one message.
inline constexpr std::size_t max_listed_nodes = 10000;

/// Lights, materials or nodes in an edit document, and lights that a session adds to its scene.
inline constexpr std::size_t max_edited_parts = 10000;
inline constexpr std::size_t max_added_lights = 256;
inline constexpr std::size_t max_edited_nodes = 100000;
/// Planes that cut a scene open, as many as the renderer's rays are cut by.
inline constexpr std::size_t max_section_planes = 6;
/// Of lights, kelvin: where the approximation of the Planckian locus holds.
inline constexpr double min_temperature = 1667.0;
inline constexpr double max_temperature = 25000.0;

/// Lengths of names, bytes.
inline constexpr std::size_t max_session_name = 64;  // viewers, presets and buffers as well
inline constexpr std::size_t max_node_name = 256;    // cameras, clips, lights, materials, variants
inline constexpr std::size_t max_bookmark_name = 120;
/// Bookmarks of a session, of all its scenes, and the data URL of one's image, bytes.
inline constexpr std::size_t max_bookmarks = 64;
inline constexpr std::size_t max_thumbnail_url = 16384;
/// Measurements of a session, of all its scenes, and the nodes of one: every change sends the list.
inline constexpr std::size_t max_measurements = 256;
inline constexpr std::size_t max_measured_nodes = 256;
/// Annotations of a session, of all its scenes, and the text of one, bytes.
inline constexpr std::size_t max_annotations = 256;
inline constexpr std::size_t max_annotation_text = 2000;
inline constexpr std::uint32_t max_idle_timeout = 31'536'000;  // seconds
inline constexpr std::size_t max_scene_name = 512;  // paths in the catalogue; environments as well

/// Keys of a camera's path, and how long it takes, seconds.
inline constexpr std::size_t min_path_keys = 2;
inline constexpr std::size_t max_path_keys = 200;
inline constexpr double min_path_seconds = 0.1;
inline constexpr double max_path_seconds = 3600.0;
/// Frames of a clip or a turntable, and their rate in frames per second.
inline constexpr std::uint32_t max_rendered_frames = 100000;
inline constexpr double min_clip_rate = 0.1;
inline constexpr double max_clip_rate = 1000.0;
/// Time in a clip, seconds.
inline constexpr double max_clip_time = 1e6;
/// Free part of an image on each side of the scene that is fitted into it.
inline constexpr double max_margin = 0.45;
/// Expected structural similarity at which an image is good enough.
inline constexpr double min_similarity = 0.1;
inline constexpr double max_similarity = 0.999;
/// Of an image, seconds.
inline constexpr double min_time_limit = 0.01;
inline constexpr double max_time_limit = 86400.0;
inline constexpr std::size_t max_path = 4096;  // files and templates of their names; bytes

}  // namespace heliograph::protocol
