#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/session_messages.hpp"

// Messages about the bookmarks of a session: named cameras of a scene, shared by all viewers.

namespace heliograph::protocol {

struct Bookmark {
  std::string name;
  Vec3 eye{};
  Vec3 target{};
  Vec3 up{0.0f, 1.0f, 0.0f};
  float vertical_fov = 45.0f;
  std::optional<std::string> thumbnail;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &Bookmark::name, "Its name, unique among the scene's bookmarks."),
        field("eye", &Bookmark::eye, "Position of the camera, world space.").unit("metres"),
        field("target", &Bookmark::target, "The point at the centre of the image.").unit("metres"),
        field("up", &Bookmark::up, "The up direction of the image."),
        field("vertical_fov", &Bookmark::vertical_fov, "Vertical field of view.").unit("degrees"),
        field("thumbnail", &Bookmark::thumbnail, "A small image as a data URL, if it has one."),
    };
  }
  bool operator==(const Bookmark&) const = default;
};

struct BookmarkList {
  std::optional<std::string> scene;
  std::vector<Bookmark> bookmarks;

  static constexpr auto fields() {
    return std::tuple{
        field("scene", &BookmarkList::scene, "The scene that the session shows; null: none.")
            .or_null(),
        field("bookmarks", &BookmarkList::bookmarks, "Its bookmarks, the oldest first."),
    };
  }
  bool operator==(const BookmarkList&) const = default;
};

struct BookmarkAdd {
  std::optional<std::string> name;
  std::optional<Vec3> eye;
  std::optional<Vec3> target;
  std::optional<Vec3> up;
  std::optional<float> vertical_fov;
  std::optional<std::string> thumbnail;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &BookmarkAdd::name,
              "Its name; absent: the first free \"View 1\", \"View 2\".")
            .length(1, max_bookmark_name),
        field("eye", &BookmarkAdd::eye, "Position of the camera; absent: the session's.")
            .range(-max_coordinate, max_coordinate)
            .unit("metres"),
        field("target", &BookmarkAdd::target,
              "The point at the centre of the image; absent: the session's.")
            .range(-max_coordinate, max_coordinate)
            .unit("metres"),
        field("up", &BookmarkAdd::up, "The up direction of the image; absent: the session's.")
            .range(-max_coordinate, max_coordinate),
        field("vertical_fov", &BookmarkAdd::vertical_fov,
              "Vertical field of view; absent: the session's.")
            .range(min_field_of_view, max_field_of_view)
            .unit("degrees"),
        field("thumbnail", &BookmarkAdd::thumbnail,
              "A small JPEG, PNG or WebP image as a data URL (data:image/...;base64,...).")
            .length(1, max_thumbnail_url),
    };
  }
  bool operator==(const BookmarkAdd&) const = default;
};

struct BookmarkName {
  std::string name;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &BookmarkName::name, "A name from bookmarks.list.")
            .length(1, max_bookmark_name),
    };
  }
  bool operator==(const BookmarkName&) const = default;
};

struct BookmarkRename {
  std::string name;
  std::string to;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &BookmarkRename::name, "A name from bookmarks.list.")
            .length(1, max_bookmark_name),
        field("to", &BookmarkRename::to, "Its new name.").length(1, max_bookmark_name),
    };
  }
  bool operator==(const BookmarkRename&) const = default;
};

struct BookmarksChanged {
  BookmarkList list;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("list", &BookmarksChanged::list, "The bookmarks after the change."),
        field("by", &BookmarksChanged::by, "The viewer that changed them; empty: the server."),
    };
  }
  bool operator==(const BookmarksChanged&) const = default;
};

}  // namespace heliograph::protocol
