#include "scene/gltf/export/light_export.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "scene/gltf/export/animation_channels.hpp"
#include "scene/gltf/export/light_values.hpp"
#include "scene/gltf/schema/place.hpp"
#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

using nlohmann::json;

constexpr const char* lights_extension = "KHR_lights_punctual";

bool is_area_light(const shared::Light& light) {
  return light.type >= shared::light_rectangle;
}

/// The transform of a node that shines as the light does.
glm::dmat4 world_of(const shared::Light& light) {
  const glm::dvec3 x(light.tangent);
  const glm::dvec3 z = -glm::dvec3(light.direction);
  return {glm::dvec4(x, 0.0), glm::dvec4(glm::cross(z, x), 0.0), glm::dvec4(z, 0.0),
          glm::dvec4(light.position, 1.0)};
}

/// The place of a light in the world, of a node without a parent.
void write_place(json& node, const shared::Light& light) {
  const glm::dquat rotation = glm::normalize(glm::quat_cast(glm::dmat3(world_of(light))));
  node["translation"] = {light.position.x, light.position.y, light.position.z};
  node["rotation"] = {rotation.x, rotation.y, rotation.z, rotation.w};
}

void write_place_below(json& node, const glm::mat4& parent, const shared::Light& light) {
  const glm::dmat4 local = glm::inverse(glm::dmat4(parent)) * world_of(light);
  json matrix = json::array();
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      const double last = column == 3 ? 1.0 : 0.0;
      matrix.push_back(row == 3 ? last : local[column][row]);
    }
  }
  node["matrix"] = std::move(matrix);
}

void erase_place(json& node) {
  for (const char* const member : {"translation", "rotation", "scale", "matrix"}) {
    node.erase(member);
  }
}

/// Joints, and nodes that animations move: their transforms are not the light's alone.
std::set<std::size_t> find_held_nodes(EditableDocument& document) {
  std::set<std::size_t> held = find_animated_nodes(document);
  for (const json& skin : document.list("skins")) {
    for (const json& joint : skin.at("joints")) held.insert(joint.get<std::size_t>());
  }
  return held;
}

class LightExport {
 public:
  LightExport(EditableDocument& document, const Scene& scene, DocumentNodes nodes)
      : document_(document), scene_(scene), nodes_(nodes), held_(find_held_nodes(document)) {
    for (const json& node : document.list("nodes")) {
      if (const auto light = punctual_of(node)) ++uses_[*light];
    }
  }

  void change(const Light& light, const LightChange& now) {
    const std::size_t node = *nodes_[*light.node];
    if (now.removed) return detach(document_.node(node));
    const bool moved = light.device.position != now.device.position ||
                       light.device.direction != now.device.direction;
    const bool other = now.off || has_other_values(light.device, now.device);
    if (is_area_light(now.device) && (moved || other)) warn_of_area(light.name);
    if (other) write_values(node, light.device, now);
    if (moved) move(node, *light.node, now.device);
  }

  void add(const LightChange& light) {
    json node{{"name", light.name}};
    write_place(node, light.device);
    if (is_area_light(light.device)) {
      node["extras"]["areaLight"] = new_area_light(light);
      warn_of_area(light.name);
    } else {
      const std::size_t index = punctual_lights().size();
      punctual_lights().push_back(new_punctual_light(light));
      node["extensions"][lights_extension]["light"] = index;
      write_size(document_.extras(node, "a new node"), light.device);
      document_.use(lights_extension);
    }
    document_.append_root(std::move(node));
  }

 private:
  static std::optional<std::size_t> punctual_of(const json& node) {
    const auto extensions = node.find("extensions");
    if (extensions == node.end() || !extensions->contains(lights_extension)) return {};
    return extensions->at(lights_extension).at("light").get<std::size_t>();
  }

  static bool has_area_light(const json& node) {
    const auto extras = node.find("extras");
    if (extras == node.end() || !extras->is_object()) return false;
    const auto area = extras->find("areaLight");
    return area != extras->end() && area->is_object();
  }

  json& punctual_lights() {
    json& lights = document_.root()["extensions"][lights_extension]["lights"];
    if (lights.is_null()) lights = json::array();
    return lights;
  }

  void warn_of_area(const std::string& name) {
    document_.warn("light " + in_quotes(name) +
                   ": glTF has no area lights; it is written to extras.areaLight of its node, "
                   "which other programs ignore");
  }

  static void detach(json& node) {
    erase_within(node, "extensions", lights_extension);
    if (has_area_light(node)) erase_within(node, "extras", "areaLight");
  }

  void write_values(std::size_t index, const shared::Light& before, const LightChange& now) {
    json& node = document_.node(index);
    if (has_area_light(node)) return write_area_light(node["extras"]["areaLight"], now);
    json& light = own_light(node, edited_members(before, now));
    write_punctual_light(light, before, now);
    if (has_other_size(before, now.device)) {
      write_size(document_.extras(node, item_path("", "nodes", index)), now.device);
    }
  }

  /// The light of a node that it shares with no other. `edited` members are not animated, others
  /// as before.
  json& own_light(json& node, std::span<const std::string_view> edited) {
    json& reference = node["extensions"][lights_extension]["light"];
    const auto index = reference.get<std::size_t>();
    json& lights = punctual_lights();
    if (uses_[index] == 1) {
      erase_light_channels(document_, index, edited);
      return lights[index];
    }
    --uses_[index];
    json copy = lights[index];
    lights.push_back(std::move(copy));
    const std::size_t own = lights.size() - 1;
    copy_light_channels(document_, index, own, edited);
    reference = own;
    uses_[own] = 1;
    return lights.back();
  }

  /// Whether a node has nothing that its transform moves but the light.
  bool is_bare(std::size_t index) {
    const json& node = document_.node(index);
    for (const char* const member : {"children", "mesh", "camera", "skin"}) {
      if (node.contains(member)) return false;
    }
    const auto extensions = node.find("extensions");
    const std::size_t own = punctual_of(node) ? 1 : 0;
    return !held_.contains(index) && (extensions == node.end() || extensions->size() == own);
  }

  /// `index` in the document, `node` in the scene.
  void move(std::size_t index, std::uint32_t node, const shared::Light& light) {
    if (is_bare(index)) {
      const auto parent = scene_.nodes[node].parent;
      if (!parent || is_regular(*parent)) {
        erase_place(document_.node(index));
        if (!parent) return write_place(document_.node(index), light);
        return write_place_below(document_.node(index), scene_.nodes[*parent].world, light);
      }
    }
    json child = take_light(document_.node(index));
    if (!is_regular(node)) {
      write_place(child, light);
      return document_.append_root(std::move(child));
    }
    write_place_below(child, scene_.nodes[node].world, light);
    const std::size_t added = document_.append("nodes", std::move(child));
    document_.node(index)["children"].push_back(added);
  }

  bool is_regular(std::uint32_t node) const {
    return std::isnormal(glm::determinant(glm::mat3(scene_.nodes[node].world)));
  }

  /// A node with the light of another, which loses it.
  static json take_light(json& node) {
    json taken = json::object();
    if (node.contains("name")) taken["name"] = node["name"];
    if (punctual_of(node)) {
      taken["extensions"][lights_extension] = node["extensions"][lights_extension];
    }
    for (const char* const member : {"areaLight", "angularDiameterDeg", "radius"}) {
      const auto extras = node.find("extras");
      if (extras == node.end() || !extras->is_object() || !extras->contains(member)) continue;
      taken["extras"][member] = (*extras)[member];
      erase_within(node, "extras", member);
    }
    erase_within(node, "extensions", lights_extension);
    return taken;
  }

  EditableDocument& document_;
  const Scene& scene_;
  const DocumentNodes nodes_;
  const std::set<std::size_t> held_;
  std::map<std::size_t, std::size_t> uses_;  // by light of the document: how many nodes have it
};

}  // namespace

void export_lights(EditableDocument& document, const Scene& scene, DocumentNodes nodes,
                   std::span<const LightChange> lights) {
  LightExport writer(document, scene, nodes);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (i < scene.lights.size()) {
      writer.change(scene.lights[i], lights[i]);
    } else if (!lights[i].removed) {
      writer.add(lights[i]);
    }
  }
}

}  // namespace heliograph::scene
