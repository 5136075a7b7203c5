#include "scene/gltf/environment/image_light.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/gltf/document/extension_value.hpp"
#include "scene/gltf/environment/cube_map.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

constexpr const char* extension_name = "EXT_lights_image_based";

/// The light that a scene refers to.
std::optional<ExtensionValue> find_light(const tinygltf::Model& model, std::uint32_t scene) {
  const auto used = find_extension(model.scenes[scene].extensions, extension_name, "");
  if (!used) return std::nullopt;
  const tinygltf::Value& lights = model.extensions.at(extension_name).Get("lights");
  const std::uint32_t index = *used->index("light");
  return ExtensionValue(lights.Get(static_cast<int>(index)),
                        item_path(std::string("extensions.") + extension_name, "lights", index));
}

glm::quat rotation_of(const ExtensionValue& light) {
  const auto [x, y, z, w] = light.numbers<4>("rotation", {0.0f, 0.0f, 0.0f, 1.0f});
  const glm::dquat rotation(w, x, y, z);
  const double length = glm::length(rotation);
  if (length < 1e-6) light.refuse("rotation", "is not a quaternion of unit length");
  return glm::quat(rotation / length);
}

class FaceReader {
 public:
  FaceReader(const ExtensionValue& light, const ImageLightContext& context)
      : light_(light),
        context_(context),
        size_(static_cast<std::uint32_t>(*light.integer("specularImageSize"))),
        place_(item_path(light.path(), "specularImages", 0)) {}

  /// An image of several faces is decoded once.
  CubeFaces read() {
    CubeFaces faces;
    const std::vector<std::uint32_t> images = light_.index_list("specularImages", 0);
    std::map<std::uint32_t, std::shared_ptr<const CubeFace>> known;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const auto [found, is_new] = known.try_emplace(images[i]);
      if (is_new) found->second = read_face(images[i]);
      faces[i] = found->second;
    }
    return faces;
  }

 private:
  /// Null where there is none.
  std::shared_ptr<const CubeFace> read_face(std::uint32_t image) {
    throw_if_cancelled(context_.stop);
    const ImageSource& source = context_.images.at(image);
    ImageTexels texels = decode_texels(source, context_.limits, context_.texels);
    if (!texels.problem.empty()) {
      context_.warnings.add(texels.problem + ": its faces in " + place_ + " are black");
      return nullptr;
    }
    const auto [width, height] = texels.size;
    if (width != size_ || height != size_) {
      const std::string problem = place_ + ": " + source.path + " is " + std::to_string(width) +
                                  " x " + std::to_string(height) +
                                  " pixels, and specularImageSize " + std::to_string(size_);
      if (context_.limits.strict_assets) throw ImportError(problem);
      context_.warnings.add(problem + (width == height ? "" : ": its faces are black"));
    }
    if (width != height) return nullptr;
    return std::make_shared<const CubeFace>(CubeFace{width, std::move(texels.rgba)});
  }

  const ExtensionValue& light_;
  const ImageLightContext& context_;
  const std::uint32_t size_;
  const std::string place_;
};

}  // namespace

// The smaller mips are the largest one blurred for rough surfaces, and the irradiance coefficients
// its integrals over the hemispheres. The renderer computes both from the environment, as for any
// other, so that they are checked by the table only.
std::shared_ptr<const Environment> read_image_light(const tinygltf::Model& model,
                                                    std::optional<std::uint32_t> scene,
                                                    const ImageLightContext& context) {
  if (!scene) return nullptr;
  const auto light = find_light(model, *scene);
  if (!light) return nullptr;
  const glm::quat rotation = rotation_of(*light);
  const CubeFaces faces = FaceReader(*light, context).read();
  if (std::ranges::none_of(faces, [](const auto& face) { return face != nullptr; })) {
    context.warnings.add(light->path() + " has no face that can be read, and is left out");
    return nullptr;
  }
  const std::uint64_t width = environment_width(faces);
  context.bytes.take(width * width / 2, sizeof(glm::vec3), light->path());
  return std::make_shared<const Environment>(
      environment_of_cube(faces, rotation, light->number("intensity", 1.0f), context.stop));
}

}  // namespace heliograph::scene
