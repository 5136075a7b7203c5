#include "scene/import.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <new>
#include <optional>

#include "scene/accessors.hpp"
#include "scene/cameras.hpp"
#include "scene/gltf_file.hpp"
#include "scene/images.hpp"
#include "scene/lights.hpp"
#include "scene/materials.hpp"
#include "scene/meshes.hpp"
#include "scene/nodes.hpp"
#include "scene/primitives.hpp"
#include "scene/references.hpp"
#include "scene/textures.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {
namespace {

// Farther out than this, single precision has nothing left to say.
constexpr float farthest = 1e12f;

bool is_finite(const glm::mat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(matrix[column][row])) return false;
    }
  }
  return true;
}

class Importer {
 public:
  Importer(const std::filesystem::path& path, const ImportLimits& limits,
           const ImportProgress& progress)
      : limits_(limits), progress_(progress) {
    report("reading", 0.0f);
    file_.emplace(path, limits);
    scene_.name = path.stem().string();
  }

  Scene import() {
    const JsonValue root = file_->root();
    for (const std::string& name : file_->ignored_extensions())
      warnings_.add("extension " + name + " is ignored");

    const std::vector<Accessor> accessors = read_accessors(*file_, limits_);
    check_skins(root, accessors);
    check_animations(root, accessors);
    TextureTable textures(root);
    MaterialTable materials = read_materials(root, textures, warnings_);
    scene_.materials = std::move(materials.materials);
    scene_.material_names = std::move(materials.names);
    const PrimitiveTable primitives =
        read_primitives(root, accessors, scene_.materials.size(), limits_, warnings_);
    const std::vector<Light> lights = read_lights(root);
    const std::vector<Camera> cameras = read_cameras(root);
    NodeTable nodes = read_nodes(root, lights.size(), limits_);
    const std::vector<ImageSource> images = read_image_sources(*file_);

    report("meshes", 0.1f);
    build_meshes(primitives, accessors);
    report("images", 0.3f);
    scene_.textures = textures.used_textures();
    scene_.images = decode_images(images, textures.image_uses(), limits_, [&](float fraction) {
      report("images", 0.3f + 0.65f * fraction);
    });
    build_alpha_heap(scene_);

    place_instances(nodes, primitives);
    place_lights_and_cameras(nodes, lights, cameras);
    if (nodes.has_skins) warnings_.add("skins are shown in the pose of their vertices");
    scene_.nodes = std::move(nodes.nodes);
    scene_.warnings = warnings_.take();
    report("done", 1.0f);
    return std::move(scene_);
  }

 private:
  void report(std::string_view stage, float fraction) const {
    if (progress_) progress_(stage, fraction);
  }

  // The one default material is added only when something lacks its own.
  std::uint32_t default_material_index() {
    if (!default_material_) {
      default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.push_back(default_material());
      scene_.material_names.push_back("default");
    }
    return *default_material_;
  }

  void build_meshes(const PrimitiveTable& table, const std::vector<Accessor>& accessors) {
    std::vector<std::uint32_t> materials;
    for (const Primitive& primitive : table.primitives) {
      materials.push_back(primitive.material ? *primitive.material : default_material_index());
    }
    if (scene_.materials.empty()) default_material_index();
    scene_.meshes.resize(table.primitives.size());
    tbb::parallel_for(std::size_t(0), table.primitives.size(), [&](std::size_t i) {
      scene_.meshes[i] = build_mesh(table.primitives[i], accessors, materials[i], scene_.materials);
    });
  }

  void place_instances(const NodeTable& nodes, const PrimitiveTable& primitives) {
    for (std::uint32_t i = 0; i < nodes.nodes.size(); ++i) {
      const glm::mat4& world = nodes.nodes[i].world;
      if (!nodes.attachments[i].mesh) continue;
      const float determinant = glm::determinant(glm::mat3(world));
      if (!std::isnormal(determinant)) {
        warnings_.add(nodes.paths[i] + " is scaled to nothing and was left out");
        continue;
      }
      for (const std::uint32_t mesh : primitives.of_mesh[*nodes.attachments[i].mesh]) {
        scene_.instances.push_back({mesh, i});
        if (scene_.instances.size() > limits_.instances) {
          throw ImportError("the scene exceeds the limit of " + std::to_string(limits_.instances) +
                            " instances");
        }
        include_in_bounds(scene_.meshes[mesh].bounds, world, nodes.paths[i]);
      }
    }
  }

  void include_in_bounds(const Bounds& mesh, const glm::mat4& world, const std::string& path) {
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 point(corner & 1 ? mesh.maximum.x : mesh.minimum.x,
                            corner & 2 ? mesh.maximum.y : mesh.minimum.y,
                            corner & 4 ? mesh.maximum.z : mesh.minimum.z);
      const glm::vec3 placed(world * glm::vec4(point, 1.0f));
      for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(placed[axis]) <= farthest))
          throw ImportError(path + ": places its mesh too far out");
      }
      scene_.bounds.include(placed);
    }
  }

  void place_lights_and_cameras(const NodeTable& nodes, const std::vector<Light>& lights,
                                const std::vector<Camera>& cameras) {
    for (std::size_t i = 0; i < nodes.nodes.size(); ++i) {
      const Node& node = nodes.nodes[i];
      const NodeAttachments& attached = nodes.attachments[i];
      if ((attached.light || attached.camera) && !is_finite(node.world)) {
        throw ImportError(nodes.paths[i] + ": places its light or camera too far out");
      }
      if (attached.light) {
        scene_.lights.push_back(
            place_light(lights[*attached.light], node.name, node.world, attached.angular_diameter));
      }
      if (attached.camera) {
        scene_.cameras.push_back(
            place_camera(cameras[*attached.camera], node.name, node.world, scene_.bounds));
      }
    }
  }

  const ImportLimits& limits_;
  const ImportProgress& progress_;
  std::optional<GltfFile> file_;
  Warnings warnings_;
  Scene scene_;
  std::optional<std::uint32_t> default_material_;
};

}  // namespace

Scene import_gltf(const std::filesystem::path& path, const ImportLimits& limits,
                  const ImportProgress& progress) {
  try {
    return Importer(path, limits, progress).import();
  } catch (const std::bad_alloc&) {
    throw ImportError("the scene needs more memory than there is");
  }
}

}  // namespace heliograph::scene
