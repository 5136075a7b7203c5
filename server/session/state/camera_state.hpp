#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"
#include "scene/scene.hpp"
#include "stream/encoded_frame.hpp"

namespace heliograph::session {

/// The camera of a session, in world space. A refused request changes nothing. Not thread safe.
class CameraState {
 public:
  /// Takes over the camera of another session; for this one it is a discontinuity.
  void copy_from(const CameraState& other);
  /// Shows what the camera of another session shows now. It is a discontinuity where that jumped
  /// since it was taken over before, when it had done so `before` times; null: where it is taken
  /// over for the first time, and this one shows something else.
  void take_over(const CameraState& other, std::optional<std::uint64_t> before);
  /// The first camera of a new scene, or one that shows all of it. `aspect`: width / height.
  void reset(const scene::Scene& scene, float aspect);
  /// The scene that the camera was named in is gone.
  void clear_name() { name_.reset(); }

  /// `by`: the viewer whose input this is.
  protocol::Result<void> set(const protocol::CameraSet& request, const scene::Scene& scene,
                             const std::string& by);
  protocol::Result<void> orbit(const protocol::CameraOrbit& request, const std::string& by);
  /// Shows all of `bounds`.
  void fit(const scene::Bounds& bounds, float aspect);
  void remove_viewer(const std::string& viewer) { input_seqs_.erase(viewer); }
  /// Knows the inputs that another camera has taken in place of this one.
  void take_inputs(const CameraState& other) { input_seqs_ = other.input_seqs_; }

  const scene::Camera& camera() const { return camera_; }
  /// How often it was moved.
  std::uint64_t moves() const { return moves_; }
  /// How often it jumped: histories of the image before do not apply.
  std::uint64_t discontinuities() const { return discontinuities_; }
  /// The newest input of each viewer.
  std::vector<stream::InputEcho> inputs() const;
  /// Whether this clip moves the camera: while it is one of the scene's own, as it was made.
  bool follows(const scene::Scene& scene, const std::string& clip) const;
  /// `scene_rev`: see SessionCore.
  protocol::Camera message(std::uint32_t rev, std::uint32_t scene_rev) const;

 private:
  void move(const scene::Camera& camera, std::optional<std::string> name);

  scene::Camera camera_;
  std::optional<std::string> name_;  // of the scene's camera that it is
  bool fitted_ = false;              // placed to show the whole scene
  std::uint64_t moves_ = 0;
  std::uint64_t discontinuities_ = 0;
  std::map<std::string, std::uint32_t> input_seqs_;  // by viewer
};

}  // namespace heliograph::session
