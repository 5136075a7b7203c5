#include "scene/gltf/export/animation_channels.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

namespace heliograph::scene {
namespace {

using nlohmann::json;

constexpr const char* pointer_channel_extension = "KHR_animation_pointer";
constexpr std::string_view node_list = "/nodes/";
constexpr std::string_view light_list = "/extensions/KHR_lights_punctual/lights/";

/// What a pointer names: a member of an object in a list of the document.
struct PointedMember {
  std::size_t object = 0;
  std::string_view member;  // the rest of the pointer, within the document
};

/// What a channel animates by a pointer into `list`; nullopt where it animates something else.
std::optional<PointedMember> pointed_member(const json& channel, std::string_view list) {
  const json& target = channel.at("target");
  if (target.at("path") != "pointer") return std::nullopt;
  const json& text = target.at("extensions").at(pointer_channel_extension).at("pointer");
  std::string_view pointer = text.get_ref<const std::string&>();
  if (!pointer.starts_with(list)) return std::nullopt;
  pointer.remove_prefix(list.size());
  PointedMember pointed;
  const char* const last = pointer.data() + pointer.size();
  const auto [end, error] = std::from_chars(pointer.data(), last, pointed.object);
  if (error != std::errc() || end == last || *end != '/') return std::nullopt;
  pointed.member = pointer.substr(static_cast<std::size_t>(end - pointer.data()) + 1);
  return pointed;
}

bool is_transform(std::string_view member) {
  return member == "translation" || member == "rotation" || member == "scale";
}

bool animates_edited(const PointedMember& pointed, std::span<const std::string_view> edited) {
  return std::ranges::find(edited, pointed.member) != edited.end();
}

}  // namespace

std::set<std::size_t> find_animated_nodes(EditableDocument& document) {
  std::set<std::size_t> animated;
  for (const json& animation : document.list("animations")) {
    for (const json& channel : animation.at("channels")) {
      const json& target = channel.at("target");
      if (target.contains("node")) animated.insert(target.at("node").get<std::size_t>());
      const auto pointed = pointed_member(channel, node_list);
      if (pointed && is_transform(pointed->member)) animated.insert(pointed->object);
    }
  }
  return animated;
}

void copy_light_channels(EditableDocument& document, std::size_t from, std::size_t to,
                         std::span<const std::string_view> edited) {
  for (json& animation : document.list("animations")) {
    json added = json::array();
    for (const json& channel : animation.at("channels")) {
      const auto pointed = pointed_member(channel, light_list);
      if (!pointed || pointed->object != from || animates_edited(*pointed, edited)) continue;
      json copy = channel;
      copy["target"]["extensions"][pointer_channel_extension]["pointer"] =
          std::string(light_list) + std::to_string(to) + "/" + std::string(pointed->member);
      added.push_back(std::move(copy));
    }
    json& channels = animation["channels"];
    for (json& channel : added) channels.push_back(std::move(channel));
  }
}

void erase_light_channels(EditableDocument& document, std::size_t light,
                          std::span<const std::string_view> edited) {
  json& animations = document.list("animations");
  for (auto animation = animations.begin(); animation != animations.end();) {
    json& channels = animation->at("channels");
    const auto is_edited = [&](const json& channel) {
      const auto pointed = pointed_member(channel, light_list);
      return pointed && pointed->object == light && animates_edited(*pointed, edited);
    };
    channels.erase(std::remove_if(channels.begin(), channels.end(), is_edited), channels.end());
    animation = channels.empty() ? animations.erase(animation) : std::next(animation);
  }
}

}  // namespace heliograph::scene
