#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"

// Messages about planes that cut a scene open.

namespace heliograph::protocol {

struct SectionPlane {
  Vec3 normal{};
  float offset = 0.0f;
  bool enabled = true;

  static constexpr auto fields() {
    return std::tuple{
        field("normal", &SectionPlane::normal,
              "Direction of what is cut away, world space; any length but 0.")
            .range(-1e6, 1e6),
        field("offset", &SectionPlane::offset,
              "Distance of the plane from the origin, in the direction of the normal: what is "
              "farther is cut away.")
            .range(-max_coordinate, max_coordinate)
            .unit("metres"),
        field("enabled", &SectionPlane::enabled, "Whether the plane cuts.").or_default(),
    };
  }
  bool operator==(const SectionPlane&) const = default;
};

struct Section {
  static constexpr bool strict = true;
  std::vector<SectionPlane> planes;
  Vec3 cap_color{0.5f, 0.12f, 0.08f};

  static constexpr auto fields() {
    return std::tuple{
        field("planes", &Section::planes,
              "What is in front of any of them is gone, with its shadows and reflections.")
            .length(0, max_section_planes),
        field("cap_color", &Section::cap_color,
              "Linear colour of the caps that close solids where they are cut.")
            .range(0, 1)
            .or_default(),
    };
  }
  bool operator==(const Section&) const = default;
};

struct SectionState {
  std::vector<SectionPlane> planes;
  Vec3 cap_color{};
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("planes", &SectionState::planes, "The planes, with normals of length 1."),
        field("cap_color", &SectionState::cap_color, "Linear colour of the caps."),
        field("rev", &SectionState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const SectionState&) const = default;
};

struct SectionChanged {
  std::vector<SectionPlane> planes;
  Vec3 cap_color{};
  std::uint32_t rev = 0;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("planes", &SectionChanged::planes, "The planes, with normals of length 1."),
        field("cap_color", &SectionChanged::cap_color, "Linear colour of the caps."),
        field("rev", &SectionChanged::rev, "Revision of the session's state."),
        field("by", &SectionChanged::by, "The viewer that changed it; empty: the server."),
    };
  }
  bool operator==(const SectionChanged&) const = default;
};

}  // namespace heliograph::protocol
