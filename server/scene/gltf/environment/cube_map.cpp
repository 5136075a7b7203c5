#include "scene/gltf/environment/cube_map.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/first_failure.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

// Filters of the renderer need some texels even where the cube has few.
constexpr std::uint32_t least_width = 64;
/// 100 MB of radiance. Light needs no more, and a small file cannot ask for more memory.
constexpr std::uint32_t most_width = 4096;

/// Directions of a face's middle, and of right and down in its file.
struct FaceAxes {
  glm::vec3 middle, right, down;
};

// Faces lie as in the specification of OpenGL (4.6, table 8.19: "right" is s), with the rows of
// each file in reverse: EXT_lights_image_based has images flipped, since row 0 is the first in
// glTF and the last in OpenGL. Babylon.js, which its authors wrote it for, reads them likewise.
// That engine shows the cube in a left-handed world; here +X of the cube is glTF's +X.
constexpr std::array<FaceAxes, 6> face_axes = {{
    {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
    {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},
}};

/// A point of a face, from -1 to 1 to the right and down.
struct FacePoint {
  std::size_t face = 0;
  glm::vec2 at{0.0f};
};

FacePoint face_point(const glm::vec3& direction) {
  const glm::vec3 size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t face = std::size_t(axis) * 2 + (direction[axis] < 0.0f ? 1 : 0);
  const FaceAxes& axes = face_axes[face];
  return {face,
          glm::vec2(glm::dot(direction, axes.right), glm::dot(direction, axes.down)) / size[axis]};
}

std::array<float, 256> make_linear_table() {
  std::array<float, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double encoded = double(i) / 255.0;
    table[i] =
        float(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
  }
  return table;
}

/// The radiance around a cube.
class Cube {
 public:
  explicit Cube(const CubeFaces& faces) : faces_(faces), linear_(make_linear_table()) {}

  /// Between the four nearest texels, across edges, too.
  glm::vec3 radiance(const glm::vec3& direction) const {
    const FacePoint point = face_point(direction);
    const auto& face = faces_[point.face];
    if (!face) return glm::vec3(0.0f);
    const glm::vec2 at = (point.at + 1.0f) * (0.5f * float(face->size)) - 0.5f;
    const glm::vec2 corner = glm::floor(at);
    const glm::vec2 share = at - corner;
    const glm::ivec2 first(corner);
    const auto row = [&](int y) {
      return glm::mix(texel(point.face, {first.x, y}), texel(point.face, {first.x + 1, y}),
                      share.x);
    };
    return glm::mix(row(first.y), row(first.y + 1), share.y);
  }

 private:
  /// One beyond an edge is the nearest of the face there.
  glm::vec3 texel(std::size_t index, const glm::ivec2& at) const {
    const CubeFace& face = *faces_[index];
    const int size = int(face.size);
    if (at.x >= 0 && at.y >= 0 && at.x < size && at.y < size) return decoded(face, at);
    const FaceAxes& axes = face_axes[index];
    const glm::vec2 place = (glm::vec2(at) + 0.5f) * (2.0f / float(size)) - 1.0f;
    const FacePoint point = face_point(axes.middle + place.x * axes.right + place.y * axes.down);
    const auto& other = faces_[point.face];
    if (!other) return glm::vec3(0.0f);
    const glm::ivec2 nearest((point.at + 1.0f) * (0.5f * float(other->size)));
    return decoded(*other, glm::clamp(nearest, 0, int(other->size) - 1));
  }

  // A divisor of 0 is none: the least one that a file can have takes its place.
  glm::vec3 decoded(const CubeFace& face, const glm::ivec2& at) const {
    const std::uint8_t* const rgbd =
        &face.rgbd[(std::size_t(at.y) * face.size + std::size_t(at.x)) * 4];
    const float divisor = float(std::max<std::uint8_t>(rgbd[3], 1)) / 255.0f;
    return glm::vec3(linear_[rgbd[0]], linear_[rgbd[1]], linear_[rgbd[2]]) / divisor;
  }

  const CubeFaces& faces_;
  const std::array<float, 256> linear_;
};

std::uint32_t largest_side(const CubeFaces& faces) {
  std::uint32_t side = 0;
  for (const auto& face : faces) side = std::max(side, face ? face->size : 0);
  return side;
}

/// Sines and cosines of the middles of `count` equal parts of `angle` behind `first`, radians.
std::vector<glm::vec2> sines_and_cosines(std::uint32_t count, double first, double angle) {
  std::vector<glm::vec2> result;
  result.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double at = first + angle * (i + 0.5) / count;
    result.emplace_back(std::sin(at), std::cos(at));
  }
  return result;
}

}  // namespace

std::uint32_t environment_width(const CubeFaces& faces) {
  return std::uint32_t(
      std::clamp<std::uint64_t>(std::uint64_t{4} * largest_side(faces), least_width, most_width));
}

Environment environment_of_cube(const CubeFaces& faces, const glm::quat& rotation, float intensity,
                                const std::stop_token& stop) {
  Environment environment;
  environment.width = environment_width(faces);
  environment.height = environment.width / 2;
  environment.radiance.resize(std::size_t(environment.width) * environment.height);
  // Points per texel and axis: texels of the cube are smaller near its edges.
  const std::uint32_t grid = std::clamp(4 * largest_side(faces) / environment.width, 2u, 4u);
  constexpr double pi = glm::pi<double>();
  const auto azimuths = sines_and_cosines(environment.width * grid, -pi, 2.0 * pi);
  const auto polars = sines_and_cosines(environment.height * grid, 0.0, pi);
  const glm::mat3 into_cube = glm::transpose(glm::mat3_cast(rotation));
  const Cube cube(faces);
  const auto sum_at = [&](std::uint32_t x, std::uint32_t y) {
    glm::vec3 sum(0.0f);
    for (std::uint32_t k = 0; k < grid * grid; ++k) {
      const glm::vec2 azimuth = azimuths[std::size_t(x) * grid + k % grid];
      const glm::vec2 polar = polars[std::size_t(y) * grid + k / grid];
      sum +=
          cube.radiance(into_cube * glm::vec3(polar.x * azimuth.y, polar.y, polar.x * azimuth.x));
    }
    return sum;
  };
  const float scale = intensity / float(grid * grid);
  FirstFailure failure;
  tbb::parallel_for(0u, environment.height, [&](std::uint32_t y) {
    failure.guard([&] {
      throw_if_cancelled(stop);
      for (std::uint32_t x = 0; x < environment.width; ++x) {
        environment.radiance[std::size_t(y) * environment.width + x] =
            physical_radiance(sum_at(x, y) * scale);
      }
    });
  });
  failure.rethrow();
  return environment;
}

}  // namespace heliograph::scene
