#include "scene/gltf/schema/document_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "scene/byte_budget.hpp"
#include "scene/gltf/schema/document_text.hpp"
#include "scene/gltf/schema/place.hpp"
#include "scene/gltf/schema/schema.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

using nlohmann::json;

// Memory of an object of tinygltf's model, at most, without its strings and arrays.
constexpr std::uint64_t bytes_of_object = 512;

// Some exporters write integers as 3.0: accepted as integers.
std::optional<std::uint64_t> as_integer(const json& value) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (!value.is_number_float()) return std::nullopt;
  const double number = value.get<double>();
  if (!(number >= 0.0 && number <= 9007199254740992.0) || number != std::floor(number)) {
    return std::nullopt;
  }
  return static_cast<std::uint64_t>(number);
}

std::optional<double> as_number(const json& value) {
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  if (!(std::abs(number) <= std::numeric_limits<float>::max())) return std::nullopt;
  return number;
}

std::string plain(double value) {
  std::string text = json(value).dump();
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

class Checker {
 public:
  Checker(json& document, const ImportLimits& limits, Warnings& warnings,
          const std::stop_token& stop)
      : document_(document), budget_(limits.scene_bytes), warnings_(warnings), stop_(stop) {}

  CheckedDocument check() {
    for (const TableSource& source : table_sources()) {
      plurals_[slot(source.table)] = source.plural;
      if (!source.path.empty()) counts_[slot(source.table)] = length_of(source.path);
    }
    find_used_buffers();
    object(document_, document_type(), nullptr);
    result_.text = text_.take();
    return std::move(result_);
  }

 private:
  static std::size_t slot(Table table) { return static_cast<std::size_t>(table); }

  std::size_t length_of(std::span<const std::string_view> path) const {
    const json* value = &document_;
    std::string place;
    for (const std::string_view name : path) {
      if (!value->is_object()) return 0;
      const auto found = value->find(name);
      if (found == value->end()) return 0;
      value = &*found;
      place += (place.empty() ? "" : ".") + std::string(name);
    }
    if (!value->is_array()) refuse_at(place, "must be an array");
    return value->size();
  }

  void mark_used(const json& owner) {
    const auto found = owner.is_object() ? owner.find("buffer") : owner.end();
    if (!owner.is_object() || found == owner.end()) return;
    const auto index = as_integer(*found);
    if (index && *index < used_.size()) used_[*index] = true;
  }

  /// Types are not checked yet: what is malformed here is refused later.
  void find_used_buffers() {
    used_.resize(counts_[slot(Table::buffers)]);
    const auto views = document_.is_object() ? document_.find("bufferViews") : document_.end();
    if (!document_.is_object() || views == document_.end() || !views->is_array()) return;
    for (const json& view : *views) {
      mark_used(view);
      if (!view.is_object()) continue;
      const auto extensions = view.find("extensions");
      if (extensions == view.end() || !extensions->is_object()) continue;
      for (const json& extension : *extensions) mark_used(extension);
    }
  }

  [[noreturn]] static void fail_at(const Place* place, std::string_view reason) {
    refuse_at(place ? place->text() : "", reason);
  }

  /// `place` is null for the document itself.
  void object(json& value, const ObjectType& type, const Place* place) {
    if (!value.is_object()) fail_at(place, "must be an object");
    if (type.own_table != Table::none) {
      const auto own = value.find(type.own_array);
      counts_[slot(type.own_table)] = own != value.end() && own->is_array() ? own->size() : 0;
    }
    const auto start = text_.mark();
    text_.open('{');
    // First: members of the document refer to arrays of its extensions.
    if (!type.extensions.empty()) extensions(value, type, place);
    for (const Member& member : type.members) {
      const Place at{place, member.name};
      const auto found = value.find(member.name);
      if (found == value.end()) {
        absent(member, at);
      } else if (!member.ignored_unless_object || found->is_object()) {
        text_.name(member.name);
        check(*found, member, at);
      }
    }
    if (type.extras) extras(value, type, place);
    if (type.rule) type.rule(value, *place, document_);
    text_.close('}');
    if (type.holds_bytes) {
      note_buffer(value, *place);
      text_.rewind(start);
      text_.raw(R"({"byteLength":1,"uri":"none"})");
    }
  }

  void absent(const Member& member, const Place& place) {
    if (member.required) fail_at(&place, "is missing");
    if (member.if_absent.empty() && member.extra_item.empty()) return;
    text_.name(member.name);
    if (member.if_absent == "#") {
      text_.integer(counts_[slot(member.table)]);
    } else if (member.if_absent == "@") {
      text_.write(place.owner->text());
    } else if (!member.extra_item.empty()) {
      text_.open('[');
      text_.raw(member.extra_item);
      text_.close(']');
    } else {
      text_.raw(member.if_absent);
    }
  }

  void extensions(json& value, const ObjectType& type, const Place* place) {
    const auto found = value.find("extensions");
    if (found == value.end()) return;
    const Place at{place, "extensions"};
    if (!found->is_object()) fail_at(&at, "must be an object");
    text_.name("extensions");
    text_.open('{');
    for (const Extension& extension : type.extensions) {
      const auto own = found->find(extension.name);
      if (own == found->end()) continue;
      const Place inner{&at, extension.name};
      text_.name(extension.name);
      const bool outer = std::exchange(in_extension_, true);
      object(*own, *extension.type, &inner);
      in_extension_ = outer;
    }
    text_.close('}');
  }

  void extras(json& value, const ObjectType& type, const Place* place) {
    const auto found = value.find("extras");
    if (found == value.end() || !found->is_object()) return;
    const auto extensions = value.find("extensions");
    const bool with = extensions != value.end() && extensions->contains(type.extras_with.name);
    const Place at{place, "extras"};
    text_.name("extras");
    object(*found, with ? *type.extras_with.type : *type.extras, &at);
  }

  /// Its length, and whether it has data that a view refers to.
  void note_buffer(const json& buffer, const Place& place) {
    const std::size_t index = *place.index;
    const auto extensions = buffer.find("extensions");
    const bool fallback =
        !buffer.contains("uri") && extensions != buffer.end() &&
        extensions->value(json::json_pointer("/EXT_meshopt_compression/fallback"), false);
    if (!used_[index]) warnings_.add(place.text() + " is used by nothing and was not read");
    result_.buffer_lengths.push_back(*as_integer(buffer.at("byteLength")));
    result_.buffers_with_data.push_back(used_[index] && !fallback);
  }

  void check(json& value, const Member& member, const Place& place) {
    switch (member.kind) {
      case Kind::text:
      case Kind::uri:
        return text(value, member, place);
      case Kind::boolean:
        if (!value.is_boolean()) fail_at(&place, "must be true or false");
        return text_.raw(value.get<bool>() ? "true" : "false");
      case Kind::integer:
        return integer(value, member, place);
      case Kind::number:
        return number(value, member, place, "must be a number that fits 32 bits");
      case Kind::index:
        return index(value, member, place, "must be a whole number, zero or more");
      case Kind::object:
        return object(value, *member.type, &place);
      case Kind::index_map:
      case Kind::integer_map:
        return map(value, member, place);
      case Kind::number_lists:
      case Kind::index_lists:
        return lists(value, member, place);
      default:
        return array(value, member, place);
    }
  }

  void array(json& value, const Member& member, const Place& place) {
    const bool of_numbers = member.kind == Kind::numbers;
    const std::string reason =
        !of_numbers          ? "must be an array"
        : member.length == 0 ? "must be an array of numbers"
                             : "must be an array of " + std::to_string(member.length) + " numbers";
    if (!value.is_array()) fail_at(&place, reason);
    if (of_numbers && member.length != 0 && value.size() != member.length) {
      fail_at(&place, reason);
    }
    if (value.size() < member.least_items) fail_at(&place, "must not be empty");
    text_.open('[');
    for (std::size_t i = 0; i < value.size(); ++i) {
      throw_if_cancelled(stop_, i);
      const Place at{place.owner, place.member, i};
      item(value[i], member, of_numbers || member.kind == Kind::indices ? place : at, reason);
    }
    if (!member.extra_item.empty()) text_.raw(member.extra_item);
    text_.close(']');
  }

  /// Errors name an array of numbers, not its items.
  void item(json& value, const Member& member, const Place& place, const std::string& reason) {
    switch (member.kind) {
      case Kind::numbers:
        return number(value, member, place, reason);
      case Kind::indices:
        return index(value, member, place, "must contain whole numbers, zero or more");
      case Kind::texts:
        if (!value.is_string()) fail_at(&place, "must be a string");
        return text_.write(value.get_ref<const std::string&>());
      case Kind::index_maps:
        return map(value, member, place);
      default:
        budget_.take(1, bytes_of_object, place.text());
        return object(value, *member.type, &place);
    }
  }

  /// Errors name a list, not its items.
  void lists(json& value, const Member& member, const Place& place) {
    const bool of_numbers = member.kind == Kind::number_lists;
    const std::string list_reason = "must be an array of " + std::to_string(member.length) +
                                    (of_numbers ? " numbers" : " indices");
    if (!value.is_array()) fail_at(&place, "must be an array");
    if (member.lists != 0 && value.size() != member.lists) {
      fail_at(&place, "must be an array of " + std::to_string(member.lists) + " arrays");
    }
    if (value.size() < member.least_items) fail_at(&place, "must not be empty");
    text_.open('[');
    for (std::size_t i = 0; i < value.size(); ++i) {
      throw_if_cancelled(stop_, i);
      const Place at{place.owner, place.member, i};
      if (!value[i].is_array() || value[i].size() != member.length) fail_at(&at, list_reason);
      budget_.take(1, bytes_of_object, place.text());
      text_.open('[');
      for (const json& inner : value[i]) {
        of_numbers ? number(inner, member, at, list_reason)
                   : index(inner, member, at, "must contain whole numbers, zero or more");
      }
      text_.close(']');
    }
    text_.close(']');
  }

  void map(json& value, const Member& member, const Place& place) {
    if (!value.is_object()) fail_at(&place, "must be an object");
    text_.open('{');
    for (auto& [name, inner] : value.items()) {
      const Place at{&place, name};
      text_.name(name);
      if (member.kind == Kind::integer_map) {
        integer(inner, member, at);
      } else {
        index(inner, member, at, "must be a whole number, zero or more");
      }
    }
    text_.close('}');
  }

  void text(json& value, const Member& member, const Place& place) {
    if (!value.is_string()) fail_at(&place, "must be a string");
    auto& string = value.get_ref<std::string&>();
    if (member.kind == Kind::uri) {
      const std::string owner = place.owner->text();
      text_.write(owner);
      result_.uris.emplace(owner, std::move(string));
      return;
    }
    if (member.choices) {
      const auto& words = member.choices->words;
      if (std::find(words.begin(), words.end(), string) == words.end()) {
        fail_at(&place, member.choices->reason);
      }
    }
    text_.write(string);
  }

  void integer(const json& value, const Member& member, const Place& place) {
    const auto number = as_integer(value);
    if (!number) fail_at(&place, "must be a whole number, zero or more");
    if (member.choices) {
      const auto& numbers = member.choices->numbers;
      if (std::find(numbers.begin(), numbers.end(), *number) == numbers.end()) {
        fail_at(&place, std::to_string(*number) + " " + std::string(member.choices->reason));
      }
    }
    if (*number < member.least) {
      fail_at(&place, "must be at least " + std::to_string(member.least));
    }
    if (*number > member.most) {
      fail_at(&place, "must be at most " + std::to_string(member.most));
    }
    text_.integer(*number);
    // In the values of extensions tinygltf narrows whole numbers, but not others.
    if (in_extension_ && *number > 0x7fffffffu) text_.make_real();
  }

  void index(const json& value, const Member& member, const Place& place, std::string_view reason) {
    const auto number = as_integer(value);
    if (!number) fail_at(&place, reason);
    const std::size_t count = counts_[slot(member.table)];
    if (*number >= count) {
      fail_at(&place, std::to_string(*number) + " is not an index into " + std::to_string(count) +
                          " " + std::string(plurals_[slot(member.table)]));
    }
    text_.integer(*number);
  }

  void number(const json& value, const Member& member, const Place& place,
              std::string_view reason) {
    const auto found = as_number(value);
    if (!found) fail_at(&place, reason);
    double number = *found;
    const bool below =
        number < member.minimum || (member.above_minimum && number <= member.minimum);
    if (below && !member.clamped_below) fail_at(&place, range_of(member, true));
    if (number > member.maximum && !member.clamped_above) fail_at(&place, range_of(member, false));
    if (below || number > member.maximum) {
      number = below ? member.minimum : member.maximum;
      const std::string limit = member.clamped_below ? "outside 0..1" : "too large";
      warnings_.add(place.text() + " is " + limit + " and was clamped");
    }
    text_.number(number);
  }

  static std::string range_of(const Member& member, bool below) {
    const bool bounded = member.maximum != Member::unlimited;
    if (member.above_minimum && !bounded) return "must be more than " + plain(member.minimum);
    if (below && member.minimum == 0.0 && !member.above_minimum) return "must not be negative";
    if (member.minimum == -Member::unlimited) return "must be at most " + plain(member.maximum);
    return (member.above_minimum ? "must be more than " : "must be from ") + plain(member.minimum) +
           (member.above_minimum ? " and at most " : " to ") + plain(member.maximum);
  }

  json& document_;
  ByteBudget budget_;
  Warnings& warnings_;
  const std::stop_token& stop_;
  CheckedDocument result_;
  DocumentText text_;
  std::array<std::size_t, static_cast<std::size_t>(Table::count)> counts_{};
  std::array<std::string_view, static_cast<std::size_t>(Table::count)> plurals_{};
  std::vector<bool> used_;
  bool in_extension_ = false;
};

}  // namespace

CheckedDocument check_document(json& document, const ImportLimits& limits, Warnings& warnings,
                               const std::stop_token& stop) {
  return Checker(document, limits, warnings, stop).check();
}

}  // namespace heliograph::scene
