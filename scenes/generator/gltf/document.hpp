#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scenes/generator/geometry/mesh.hpp"
#include "scenes/generator/textures/texture.hpp"

namespace heliograph::scenes {

/// An extension of glTF's materials: its whole name, and numbers and colours by their names.
/// KHR_materials_emissive_strength comes from Material::emission.
struct MaterialExtension {
  using Member = std::pair<std::string, std::variant<float, glm::vec3>>;
  std::string name;
  std::vector<Member> members;
};

/// Factors are linear. A material without a recipe has no maps.
struct Material {
  std::string name;
  std::optional<TextureRecipe> texture;
  glm::vec3 color{1.0f};
  float roughness = 1.0f;  // multiplies the map where there is one
  float metallic = 1.0f;
  glm::vec3 emission{0.0f};  // may exceed 1: written with KHR_materials_emissive_strength
  float normal_scale = 1.0f;
  bool masked = false;
  float alpha_cutoff = 0.5f;     // of a masked material
  std::optional<float> opacity;  // blends the material with what is behind it
  bool double_sided = false;
  bool swept = false;  // takes part in the roughness sweep; written to the extras
  std::optional<float> uniform_roughness;  // in place of `roughness` and what the map says of it
  std::vector<MaterialExtension> extensions;

  /// Whether its highlights have a direction, that of the tangents.
  bool is_anisotropic() const;
};

struct NamedMesh {
  std::string name;
  Mesh mesh;
  int material = 0;
};

struct Camera {
  std::string name;
  float vertical_fov = 0.9f;  // radians
};

struct Light {
  std::string name;
  bool directional = false;  // otherwise a point light
  glm::vec3 color{1.0f};
  float intensity = 1.0f;  // irradiance for the sun, radiant intensity for a point light
  float range = 0.0f;      // metres; 0 = without limit
};

struct Node {
  std::string name;
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 scale{1.0f};
  int mesh = -1;
  int camera = -1;
  int light = -1;
  // Of a directional light, degrees: the full cone. Written to the extras.
  std::optional<float> angular_diameter;
};

/// One animated property of one node, linearly interpolated.
struct Channel {
  enum class Path { translation, rotation };
  int node = 0;
  Path path = Path::translation;
  std::vector<float> seconds;
  std::vector<glm::vec4> values;  // xyz for a translation, xyzw for a rotation
};

struct Animation {
  std::string name;
  std::vector<Channel> channels;
};

/// A scene as it is written to one GLB file.
struct Document {
  std::string name;
  std::string description;
  std::vector<Material> materials;
  std::vector<NamedMesh> meshes;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<Node> nodes;
  std::vector<Animation> animations;

  int add_material(Material material);
  /// Turns uv from metres into repeats of the material's texture and computes the tangents.
  int add_mesh(std::string name, Mesh mesh, int material);
  int add_node(Node node);
  int place(int mesh, glm::vec3 translation, float turn_degrees = 0.0f,
            glm::vec3 scale = glm::vec3(1.0f));
  int add_camera(const std::string& name, glm::vec3 eye, glm::vec3 target,
                 float vertical_fov_degrees);
  int add_light(Light light, Node node);

  /// Triangles and mesh nodes as drawn: a mesh counts as often as it is placed.
  std::size_t drawn_triangles() const;
  std::size_t instance_count() const;
};

/// One point of the paper's sweeps; what is not given stays as the scene has it.
struct Sweep {
  std::optional<float> roughness;     // of every swept material, all over
  std::optional<float> shadow_angle;  // angular diameter of the sun, degrees
};
void apply(const Sweep& sweep, Document& document);

/// The rotation that turns -Z into the direction from `eye` to `target`, upright.
glm::quat look_rotation(glm::vec3 eye, glm::vec3 target);

/// Direction to the sun: `azimuth` from +Z towards +X, `elevation` above the horizon, degrees.
glm::vec3 direction_to_sun(float elevation, float azimuth);

}  // namespace heliograph::scenes
