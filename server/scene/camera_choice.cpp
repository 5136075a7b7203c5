#include "scene/camera_choice.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>

namespace heliograph::scene {

const Camera* find_camera(const Scene& scene, std::string_view name) {
  const auto named = std::ranges::find(scene.cameras, name, &Camera::name);
  if (named != scene.cameras.end()) return &*named;
  std::size_t number = 0;
  const char* const end = name.data() + name.size();
  const auto parsed = std::from_chars(name.data(), end, number);
  const bool valid = parsed.ec == std::errc() && parsed.ptr == end;
  return valid && number >= 1 && number <= scene.cameras.size() ? &scene.cameras[number - 1]
                                                                : nullptr;
}

}  // namespace heliograph::scene
