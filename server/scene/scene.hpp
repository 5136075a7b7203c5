#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "shaders/shared/scene.h"

namespace heliograph::scene {

struct Bounds {
  glm::vec3 minimum{1e30f};
  glm::vec3 maximum{-1e30f};
  bool empty() const { return minimum.x > maximum.x; }
  glm::vec3 center() const { return 0.5f * (minimum + maximum); }
  float radius() const { return empty() ? 1.0f : 0.5f * glm::length(maximum - minimum); }
  void include(const glm::vec3& point);
  void include(const Bounds& other);
};

/// RGBA8 pixels, row 0 on top; every mip level follows the one before, the last is 1x1.
/// `srgb`: colour channels are sRGB encoded; mips were filtered in linear space.
struct Image {
  std::string name;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t levels = 1;
  bool srgb = false;
  std::vector<std::uint8_t> pixels;
};

enum class Filter { nearest, linear };

struct Sampler {
  std::uint32_t wrap_s = shared::wrap_repeat;
  std::uint32_t wrap_t = shared::wrap_repeat;
  Filter magnify = Filter::linear;
  Filter minify = Filter::linear;
  bool mipmapped = true;
  Filter mip_filter = Filter::linear;
  bool operator==(const Sampler&) const = default;
};

struct Texture {
  std::uint32_t image = 0;
  Sampler sampler;
};

struct Mesh {
  std::string name;
  std::vector<shared::Vertex> vertices;
  std::vector<std::uint32_t> indices;  // triangles, counter-clockwise from outside
  std::uint32_t material = 0;
  Bounds bounds;  // mesh space
};

struct Node {
  std::string name;
  std::optional<std::uint32_t> parent;  // always a smaller index: parents come first
  glm::mat4 local{1.0f};
  glm::mat4 world{1.0f};
};

/// One mesh placed in the world by a node.
struct Instance {
  std::uint32_t mesh = 0;
  std::uint32_t node = 0;
};

struct Camera {
  std::string name;
  glm::vec3 eye{0.0f, 0.0f, 1.0f};
  glm::vec3 target{0.0f};
  glm::vec3 up{0.0f, 1.0f, 0.0f};
  float vertical_fov = 45.0f;        // degrees; perspective
  float orthographic_height = 0.0f;  // metres, full height; 0: perspective
  float near_plane = 0.05f;          // metres
  float far_plane = 1000.0f;         // metres; orthographic only, perspective has none
};

/// A light with its world-space device form and the name of its node.
struct Light {
  std::string name;
  shared::Light device;
  float angular_diameter = 0.0f;  // degrees, directional only
};

/// A whole glTF scene, validated, ready for upload. Immutable once loaded.
struct Scene {
  std::string name;
  std::vector<Node> nodes;
  std::vector<Mesh> meshes;
  std::vector<std::string> material_names;
  std::vector<shared::Material> materials;  // at least one
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<std::uint8_t> alpha_heap;  // alpha of masked base colours, one byte a texel
  std::vector<Instance> instances;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  Bounds bounds;  // world space
  std::vector<std::string> warnings;

  std::uint64_t triangle_count() const;  // as drawn: instances counted
};

}  // namespace heliograph::scene
