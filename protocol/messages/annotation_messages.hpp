#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/measurement_messages.hpp"

// Messages about annotations: texts that viewers pin to surfaces of the scene.

namespace heliograph::protocol {

struct AnnotationAdd {
  SurfaceAnchor surface;
  std::string text;
  std::optional<std::string> author;
  std::optional<std::uint32_t> id;

  static constexpr auto fields() {
    return std::tuple{
        field("surface", &AnnotationAdd::surface, "Where it is pinned, from scene.snap."),
        field("text", &AnnotationAdd::text, "What it says.").length(1, max_annotation_text),
        field("author", &AnnotationAdd::author,
              "Who says it; absent: the viewer's display name, if it has one.")
            .length(0, max_session_name),
        field("id", &AnnotationAdd::id,
              "Its id, such as that of one that was removed; absent: the next one.")
            .range(1, 1e9),
    };
  }
  bool operator==(const AnnotationAdd&) const = default;
};

struct Annotation {
  std::uint32_t id = 0;
  std::string text;
  std::string author;
  SurfaceAnchor surface;
  Vec3 position{};
  Vec3 normal{};

  static constexpr auto fields() {
    return std::tuple{
        field("id", &Annotation::id, "Its id, unique among the session's annotations."),
        field("text", &Annotation::text, "What it says."),
        field("author", &Annotation::author, "Who says it; may be empty."),
        field("surface", &Annotation::surface, "Where it is pinned."),
        field("position", &Annotation::position, "Where that is now, world space.").unit("metres"),
        field("normal", &Annotation::normal, "Of the triangle's front, world space."),
    };
  }
  bool operator==(const Annotation&) const = default;
};

struct AnnotationList {
  std::optional<std::string> scene;
  std::vector<Annotation> annotations;
  std::uint32_t changes = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("scene", &AnnotationList::scene, "The scene that the session shows; null: none.")
            .or_null(),
        field("annotations", &AnnotationList::annotations, "In the order of their ids."),
        field("changes", &AnnotationList::changes,
              "Counts the changes of the session's annotations."),
    };
  }
  bool operator==(const AnnotationList&) const = default;
};

struct AnnotationEdit {
  std::uint32_t id = 0;
  std::string text;

  static constexpr auto fields() {
    return std::tuple{
        field("id", &AnnotationEdit::id, "An id from annotations.list."),
        field("text", &AnnotationEdit::text, "What it says from now on.")
            .length(1, max_annotation_text),
    };
  }
  bool operator==(const AnnotationEdit&) const = default;
};

struct AnnotationId {
  std::uint32_t id = 0;

  static constexpr auto fields() {
    return std::tuple{field("id", &AnnotationId::id, "An id from annotations.list.")};
  }
  bool operator==(const AnnotationId&) const = default;
};

struct HiddenAnnotations {
  std::vector<std::uint32_t> hidden;

  static constexpr auto fields() {
    return std::tuple{
        field("hidden", &HiddenAnnotations::hidden,
              "Ids of those within the image that a surface in front of them covers."),
    };
  }
  bool operator==(const HiddenAnnotations&) const = default;
};

struct AnnotationsChanged {
  AnnotationList list;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("list", &AnnotationsChanged::list, "The annotations after the change."),
        field("by", &AnnotationsChanged::by, "The viewer that changed them; empty: the server."),
    };
  }
  bool operator==(const AnnotationsChanged&) const = default;
};

}  // namespace heliograph::protocol
