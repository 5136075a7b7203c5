#include "session/state/bookmarks.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "protocol/limits.hpp"

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

namespace {

bool is_image(std::string_view url) {
  constexpr std::array<std::string_view, 3> beginnings{
      "data:image/jpeg;base64,", "data:image/png;base64,", "data:image/webp;base64,"};
  return std::ranges::any_of(
      beginnings, [url](std::string_view beginning) { return url.starts_with(beginning); });
}

protocol::Error unknown(const std::string& name) {
  return error::not_found("name", "the scene has no bookmark \"" + name + "\"");
}

protocol::Error taken(const std::string& path, const std::string& name) {
  return error::conflict(path, "there is a bookmark \"" + name + "\"");
}

}  // namespace

std::vector<protocol::Bookmark> Bookmarks::of_scene(const std::string& scene) const {
  std::vector<protocol::Bookmark> bookmarks;
  for (const Entry& entry : entries_) {
    if (entry.scene == scene) bookmarks.push_back(entry.bookmark);
  }
  return bookmarks;
}

Result<void> Bookmarks::add(const std::string& scene, const protocol::BookmarkAdd& request,
                            const protocol::Camera& camera) {
  if (request.name && find(scene, *request.name) != entries_.end()) {
    return taken("name", *request.name);
  }
  if (request.thumbnail && !is_image(*request.thumbnail)) {
    return error::invalid("thumbnail", "must be a data URL of a JPEG, PNG or WebP image");
  }
  const protocol::Bookmark bookmark{
      .name = request.name.value_or(free_name(scene)),
      .eye = request.eye.value_or(camera.eye),
      .target = request.target.value_or(camera.target),
      .up = request.up.value_or(camera.up),
      .vertical_fov = request.vertical_fov.value_or(camera.vertical_fov),
      .thumbnail = request.thumbnail};
  if (bookmark.eye == bookmark.target) {
    return error::invalid(request.target ? "target" : "eye", "eye and target coincide");
  }
  if (bookmark.up == protocol::Vec3{}) return error::invalid("up", "must not be zero");
  if (entries_.size() >= protocol::max_bookmarks) {
    return error::full("the session has no room for more bookmarks: remove one",
                       std::to_string(protocol::max_bookmarks) + " of all scenes");
  }
  entries_.push_back({scene, bookmark});
  return {};
}

Result<void> Bookmarks::rename(const std::string& scene, const protocol::BookmarkRename& request) {
  const auto found = find(scene, request.name);
  if (found == entries_.end()) return unknown(request.name);
  const auto other = find(scene, request.to);
  if (other != entries_.end() && other != found) return taken("to", request.to);
  found->bookmark.name = request.to;
  return {};
}

Result<void> Bookmarks::remove(const std::string& scene, const std::string& name) {
  const auto found = find(scene, name);
  if (found == entries_.end()) return unknown(name);
  entries_.erase(found);
  return {};
}

std::vector<Bookmarks::Entry>::iterator Bookmarks::find(const std::string& scene,
                                                        const std::string& name) {
  return std::ranges::find_if(entries_, [&](const Entry& entry) {
    return entry.scene == scene && entry.bookmark.name == name;
  });
}

std::string Bookmarks::free_name(const std::string& scene) {
  for (int number = 1;; ++number) {
    const std::string name = "View " + std::to_string(number);
    if (find(scene, name) == entries_.end()) return name;
  }
}

}  // namespace heliograph::session
