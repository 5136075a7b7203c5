// The table of glTF's root, scenes, nodes, cameras, lights and images.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/gltf/schema/geometry.hpp"
#include "scene/gltf/schema/materials.hpp"
#include "scene/gltf/schema/place.hpp"
#include "scene/gltf/schema/schema.hpp"

namespace heliograph::scene {
namespace schema {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double widest_view = 179.0 / 180.0 * pi;

constexpr Member asset_members[] = {text("version").needed(), text("minVersion")};
constexpr ObjectType asset = {asset_members};

void check_camera(const nlohmann::json& camera, const Place& place, const nlohmann::json&) {
  const auto& type = camera.at("type").get_ref<const std::string&>();
  if (!camera.contains(type)) refuse_at(place.text(), type, "is missing");
}

constexpr Member perspective_members[] = {
    number("yfov").above(0).clamp_above(widest_view).needed(),
    number("znear").above(0).needed(),
    number("zfar").above(0),
    number("aspectRatio").above(0),
};
constexpr ObjectType perspective = {perspective_members};
constexpr Member orthographic_members[] = {
    number("xmag").needed(),
    number("ymag").needed(),
    number("znear").at_least(0).needed(),
    number("zfar").needed(),
};
constexpr ObjectType orthographic = {orthographic_members};
constexpr std::string_view camera_words[] = {"perspective", "orthographic"};
constexpr Choices camera_types = {.words = camera_words,
                                  .reason = "is not perspective or orthographic"};
constexpr Member camera_members[] = {
    text("name"),
    text("type").one_of(camera_types).needed(),
    object("perspective", perspective),
    object("orthographic", orthographic),
};
constexpr ObjectType camera = {.members = camera_members, .rule = check_camera};

void check_image_view(const nlohmann::json& image, const Place& place,
                      const nlohmann::json& document) {
  const nlohmann::json& view =
      document.at("bufferViews").at(image.at("bufferView").get<std::uint64_t>());
  const auto extensions = view.find("extensions");
  if (extensions != view.end() && extensions->contains("EXT_meshopt_compression")) {
    refuse_at(place.text(), "bufferView", "is compressed geometry");
  }
}

void check_image(const nlohmann::json& image, const Place& place, const nlohmann::json& document) {
  const bool view = image.contains("bufferView");
  if (view) check_image_view(image, place, document);
  if (view && image.contains("uri")) refuse_at(place.text(), "has both a uri and a buffer view");
  if (!view && !image.contains("uri")) {
    refuse_at(place.text(), "has neither a uri nor a buffer view");
  }
}

constexpr Member image_members[] = {
    text("name"),
    index("bufferView", Table::buffer_views),
    uri("uri"),
};
constexpr ObjectType image = {.members = image_members, .rule = check_image};

constexpr Member spot_members[] = {
    number("innerConeAngle").at_least(0),
    number("outerConeAngle").range(0, pi / 2 + 1e-4),
};
constexpr ObjectType spot = {spot_members};
constexpr std::string_view light_words[] = {"directional", "point", "spot"};
constexpr Choices light_types = {.words = light_words,
                                 .reason = "is not directional, point or spot"};
// tinygltf refuses spot lights without the object, whose members all have defaults.
constexpr Member light_members[] = {
    text("name"),
    text("type").one_of(light_types).needed(),
    numbers("color", 3).at_least(0),
    number("intensity").at_least(0),
    number("range").above(0),
    object("spot", spot).otherwise("{}"),
};
constexpr ObjectType light = {light_members};
constexpr Member lights_members[] = {objects("lights", light)};
constexpr ObjectType lights = {lights_members};
// tinygltf drops empty objects of an array.
constexpr Member variant_members[] = {text("name").otherwise(R"("")")};
constexpr ObjectType variant = {variant_members};
constexpr Member variants_members[] = {objects("variants", variant)};
constexpr ObjectType variants = {variants_members};

// A smaller or larger file of mip 0 is found when it is read.
void check_image_light(const nlohmann::json& light_json, const Place& place,
                       const nlohmann::json&) {
  const auto size = light_json.at("specularImageSize").get<double>();
  const auto levels = static_cast<std::size_t>(std::floor(std::log2(size))) + 1;
  const std::size_t mips = light_json.at("specularImages").size();
  if (mips > levels) {
    refuse_at(place.text(), "specularImages",
              std::to_string(mips) + " mip levels are more than the " + std::to_string(levels) +
                  " of specularImageSize");
  }
}

constexpr Member image_light_members[] = {
    text("name"),
    numbers("rotation", 4),
    number("intensity").at_least(0),
    number_lists("irradianceCoefficients", 9, 3).needed(),
    index_lists("specularImages", Table::images, 6).items(1).needed(),
    integer("specularImageSize").integers(1, 1u << 30).needed(),
};
constexpr ObjectType image_light = {.members = image_light_members, .rule = check_image_light};
constexpr Member image_lights_members[] = {objects("lights", image_light)};
constexpr ObjectType image_lights = {image_lights_members};
constexpr Member scene_light_members[] = {index("light", Table::image_lights).needed()};
constexpr ObjectType scene_light = {scene_light_members};

constexpr Member node_light_members[] = {index("light", Table::lights).needed()};
constexpr ObjectType node_light = {node_light_members};
constexpr Member instancing_members[] = {index_map("attributes", Table::accessors).needed()};
constexpr ObjectType instancing = {instancing_members};
constexpr Member visibility_members[] = {boolean("visible")};
constexpr ObjectType visibility = {visibility_members};
constexpr Extension node_extensions[] = {
    {"EXT_mesh_gpu_instancing", &instancing},
    {"KHR_lights_punctual", &node_light},
    {"KHR_node_visibility", &visibility},
};

// The project's own lights. "extras" may be of any type: only these members are read.
constexpr double longest = 1e6;  // metres
constexpr std::string_view shape_words[] = {"rect", "disk"};
constexpr Choices shapes = {.words = shape_words, .reason = "is not rect or disk"};
void check_area_light(const nlohmann::json& light_json, const Place& place, const nlohmann::json&) {
  const bool disk = light_json.at("shape") == "disk";
  for (const char* const length : {"width", "height", "radius"}) {
    const bool needed = disk == (std::string_view(length) == "radius");
    if (needed && !light_json.contains(length)) refuse_at(place.text(), length, "is missing");
  }
}
constexpr Member area_light_members[] = {
    text("shape").one_of(shapes).needed(),
    number("width").range(0, longest).above_zero(),
    number("height").range(0, longest).above_zero(),
    number("radius").range(0, longest).above_zero(),
    numbers("color", 3).at_least(0),
    number("radiance").at_least(0),
};
constexpr ObjectType area_light = {.members = area_light_members, .rule = check_area_light};
constexpr Member node_extras_members[] = {object("areaLight", area_light).lenient()};
constexpr ObjectType node_extras = {node_extras_members};
constexpr Member light_extras_members[] = {
    object("areaLight", area_light).lenient(),
    number("angularDiameterDeg").range(0, 90),
    number("radius").at_least(0),
};
constexpr ObjectType light_extras = {light_extras_members};

void check_node(const nlohmann::json& node_json, const Place& place, const nlohmann::json&) {
  if (!node_json.contains("matrix")) return;
  for (const char* const part : {"translation", "rotation", "scale"}) {
    if (node_json.contains(part)) refuse_at(place.text(), part, "must not be beside a matrix");
  }
}

constexpr Member node_members[] = {
    text("name"),
    indices("children", Table::nodes),
    index("mesh", Table::meshes),
    index("skin", Table::skins),
    index("camera", Table::cameras),
    numbers("weights", 0),
    numbers("matrix", 16),
    numbers("translation", 3),
    numbers("rotation", 4),
    numbers("scale", 3),
};
constexpr ObjectType node = {.members = node_members,
                             .extensions = node_extensions,
                             .extras = &node_extras,
                             .extras_with = {"KHR_lights_punctual", &light_extras},
                             .rule = check_node};

constexpr Member scene_members[] = {text("name"), indices("nodes", Table::nodes)};
constexpr Extension scene_extensions[] = {{"EXT_lights_image_based", &scene_light}};
constexpr ObjectType scene_type = {scene_members, scene_extensions};

constexpr Extension root_extensions[] = {
    {"EXT_lights_image_based", &image_lights},
    {"KHR_lights_punctual", &lights},
    {"KHR_materials_variants", &variants},
};
constexpr Member root_members[] = {
    object("asset", asset).needed(),
    texts("extensionsUsed"),
    texts("extensionsRequired"),
    index("scene", Table::scenes),
    objects("scenes", scene_type),
    objects("buffers", buffer),
    objects("bufferViews", buffer_view).and_also(R"({"buffer":0,"byteLength":1})"),
    objects("nodes", node),
    objects("meshes", mesh),
    objects("materials", material),
    objects("textures", texture),
    objects("images", image),
    objects("samplers", sampler),
    objects("accessors", accessor),
    objects("animations", animation),
    objects("skins", skin),
    objects("cameras", camera),
};
constexpr ObjectType document = {root_members, root_extensions};

constexpr std::string_view accessors_path[] = {"accessors"};
constexpr std::string_view buffers_path[] = {"buffers"};
constexpr std::string_view views_path[] = {"bufferViews"};
constexpr std::string_view cameras_path[] = {"cameras"};
constexpr std::string_view images_path[] = {"images"};
constexpr std::string_view materials_path[] = {"materials"};
constexpr std::string_view meshes_path[] = {"meshes"};
constexpr std::string_view nodes_path[] = {"nodes"};
constexpr std::string_view samplers_path[] = {"samplers"};
constexpr std::string_view scenes_path[] = {"scenes"};
constexpr std::string_view skins_path[] = {"skins"};
constexpr std::string_view textures_path[] = {"textures"};
constexpr std::string_view lights_path[] = {"extensions", "KHR_lights_punctual", "lights"};
constexpr std::string_view image_lights_path[] = {"extensions", "EXT_lights_image_based", "lights"};
constexpr std::string_view variants_path[] = {"extensions", "KHR_materials_variants", "variants"};
constexpr TableSource sources[] = {
    {Table::accessors, "accessors", accessors_path},
    {Table::buffers, "buffers", buffers_path},
    {Table::buffer_views, "buffer views", views_path},
    {Table::cameras, "cameras", cameras_path},
    {Table::images, "images", images_path},
    {Table::materials, "materials", materials_path},
    {Table::meshes, "meshes", meshes_path},
    {Table::nodes, "nodes", nodes_path},
    {Table::samplers, "samplers", samplers_path},
    {Table::scenes, "scenes", scenes_path},
    {Table::skins, "skins", skins_path},
    {Table::textures, "textures", textures_path},
    {Table::lights, "lights", lights_path},
    {Table::image_lights, "image-based lights", image_lights_path},
    {Table::variants, "variants", variants_path},
    {Table::animation_samplers, "samplers", {}},
};

}  // namespace
}  // namespace schema

const ObjectType& document_type() {
  return schema::document;
}

std::span<const TableSource> table_sources() {
  return schema::sources;
}

}  // namespace heliograph::scene
