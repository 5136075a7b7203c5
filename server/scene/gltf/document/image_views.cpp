#include "scene/gltf/document/image_views.hpp"

#include "scene/gltf/document/extension_value.hpp"

namespace heliograph::scene {

std::vector<bool> find_image_views(const tinygltf::Model& model) {
  std::vector<bool> result(model.bufferViews.size());
  const auto set = [&](int view, bool value) {
    if (const auto index = to_index(view)) result[*index] = value;
  };
  for (const tinygltf::Image& image : model.images) set(image.bufferView, true);
  for (const tinygltf::Accessor& accessor : model.accessors) {
    set(accessor.bufferView, false);
    if (!accessor.sparse.isSparse) continue;
    set(accessor.sparse.indices.bufferView, false);
    set(accessor.sparse.values.bufferView, false);
  }
  for (const tinygltf::Mesh& mesh : model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      const auto packed = find_extension(primitive.extensions, "KHR_draco_mesh_compression", "");
      if (packed) result[*packed->index("bufferView")] = false;
    }
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (model.bufferViews[i].extensions.contains("EXT_meshopt_compression")) result[i] = false;
  }
  return result;
}

}  // namespace heliograph::scene
