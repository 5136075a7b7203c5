#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>

namespace heliograph::scene {

struct Place;
struct ObjectType;

enum class Kind {
  text,
  uri,  // tinygltf is given the place instead, and never sees an address
  texts,
  boolean,
  integer,
  number,
  numbers,
  index,
  indices,
  index_map,     // an object whose members are all indices
  index_maps,    // an array of these
  integer_map,   // an object whose members are all integers
  number_lists,  // an array of arrays of numbers
  index_lists,   // an array of arrays of indices
  object,
  objects,
};

/// The arrays that indices refer to.
enum class Table {
  none,
  accessors,
  buffers,
  buffer_views,
  cameras,
  images,
  materials,
  meshes,
  nodes,
  samplers,
  scenes,
  skins,
  textures,
  lights,
  image_lights,
  variants,
  animation_samplers,
  count
};

/// The values that a member may have, and what to say of others.
struct Choices {
  std::span<const std::string_view> words;
  std::span<const std::uint32_t> numbers;
  std::string_view reason;  // "is not ..."
};

/// A member of a glTF object: type, range, reference and requirement, as the specification has them
/// or, where noted, more lenient. The last two columns are what tinygltf needs.
struct Member {
  static constexpr double unlimited = std::numeric_limits<float>::max();
  static constexpr std::uint64_t any_size = std::numeric_limits<std::uint64_t>::max();

  std::string_view name;
  Kind kind = Kind::text;
  bool required = false;
  Table table = Table::none;      // that an index refers to
  std::uint32_t length = 0;       // of an array of numbers, or of each list; 0: any
  std::uint32_t lists = 0;        // of an array of lists; 0: any
  std::uint32_t least_items = 0;  // of an array
  double minimum = -unlimited;    // of a number
  double maximum = unlimited;     // of a number
  bool above_minimum = false;     // the minimum itself is not valid
  bool clamped_below = false;     // smaller numbers become the minimum, with a warning
  bool clamped_above = false;
  std::uint64_t least = 0;           // of an integer
  std::uint64_t most = 0x7fffffffu;  // of an integer: tinygltf narrows most of them
  const Choices* choices = nullptr;
  const ObjectType* type = nullptr;  // of an object
  bool ignored_unless_object = false;
  /// What tinygltf is given instead; "#": the length of `table`, "@": the place of the object.
  std::string_view if_absent = {};
  std::string_view extra_item = {};  // appended to the array that tinygltf is given

  // The same member, changed. Without lambdas, of which clang 14 makes no constant expressions.
  constexpr Member needed() const {
    Member m = *this;
    m.required = true;
    return m;
  }
  constexpr Member range(double from, double to) const {
    Member m = *this;
    m.minimum = from;
    m.maximum = to;
    return m;
  }
  constexpr Member at_least(double from) const { return range(from, unlimited); }
  constexpr Member above(double limit) const {
    Member m = *this;
    m.minimum = limit;
    m.above_minimum = true;
    return m;
  }
  constexpr Member above_zero() const {
    Member m = *this;
    m.above_minimum = true;
    return m;
  }
  constexpr Member clamp(double from, double to) const {
    Member m = range(from, to);
    m.clamped_below = m.clamped_above = true;
    return m;
  }
  constexpr Member clamp_above(double to) const {
    Member m = *this;
    m.maximum = to;
    m.clamped_above = true;
    return m;
  }
  constexpr Member integers(std::uint64_t from, std::uint64_t to) const {
    Member m = *this;
    m.least = from;
    m.most = to;
    return m;
  }
  constexpr Member items(std::uint32_t from) const {
    Member m = *this;
    m.least_items = from;
    return m;
  }
  constexpr Member one_of(const Choices& list) const {
    Member m = *this;
    m.choices = &list;
    return m;
  }
  constexpr Member otherwise(std::string_view json) const {
    Member m = *this;
    m.if_absent = json;
    return m;
  }
  constexpr Member and_also(std::string_view json) const {
    Member m = *this;
    m.extra_item = json;
    return m;
  }
  constexpr Member lenient() const {
    Member m = *this;
    m.ignored_unless_object = true;
    return m;
  }
};

struct Extension {
  std::string_view name = {};
  const ObjectType* type = nullptr;
};

/// An object of the document. Members that are not listed are not read.
struct ObjectType {
  std::span<const Member> members = {};
  std::span<const Extension> extensions = {};
  Table own_table = Table::none;  // an array of the object that indices within it refer to
  std::string_view own_array = {};
  /// What is read from "extras", which may be of any type; another type where the object has this
  /// extension.
  const ObjectType* extras = nullptr;
  Extension extras_with = {};
  /// Checks what concerns several members, which have been checked. @throws ImportError
  void (*rule)(const nlohmann::json& object, const Place& place,
               const nlohmann::json& document) = nullptr;
  bool holds_bytes = false;  // a buffer: tinygltf is given a stand-in
};

/// Where an array stands that indices refer to: names of members from the document's root.
struct TableSource {
  Table table;
  std::string_view plural;  // for errors
  std::span<const std::string_view> path;
};

constexpr Member text(std::string_view name) {
  return {.name = name, .kind = Kind::text};
}
constexpr Member uri(std::string_view name) {
  return {.name = name, .kind = Kind::uri};
}
constexpr Member texts(std::string_view name) {
  return {.name = name, .kind = Kind::texts};
}
constexpr Member boolean(std::string_view name) {
  return {.name = name, .kind = Kind::boolean};
}
constexpr Member integer(std::string_view name) {
  return {.name = name, .kind = Kind::integer};
}
constexpr Member number(std::string_view name) {
  return {.name = name, .kind = Kind::number};
}
constexpr Member numbers(std::string_view name, std::uint32_t length) {
  return {.name = name, .kind = Kind::numbers, .length = length};
}
constexpr Member index(std::string_view name, Table table) {
  return {.name = name, .kind = Kind::index, .table = table};
}
constexpr Member indices(std::string_view name, Table table) {
  return {.name = name, .kind = Kind::indices, .table = table};
}
constexpr Member index_map(std::string_view name, Table table) {
  return {.name = name, .kind = Kind::index_map, .table = table};
}
constexpr Member integer_map(std::string_view name) {
  return {.name = name, .kind = Kind::integer_map};
}
/// `lists` arrays, or any number for 0, of `length` numbers each.
constexpr Member number_lists(std::string_view name, std::uint32_t lists, std::uint32_t length) {
  return {.name = name, .kind = Kind::number_lists, .length = length, .lists = lists};
}
/// Any number of arrays of `length` indices each.
constexpr Member index_lists(std::string_view name, Table table, std::uint32_t length) {
  return {.name = name, .kind = Kind::index_lists, .table = table, .length = length};
}
constexpr Member object(std::string_view name, const ObjectType& type) {
  return {.name = name, .kind = Kind::object, .type = &type};
}
constexpr Member objects(std::string_view name, const ObjectType& type) {
  return {.name = name, .kind = Kind::objects, .type = &type};
}

/// The whole document.
const ObjectType& document_type();
std::span<const TableSource> table_sources();

}  // namespace heliograph::scene
