#include "scene/gltf/export/editable_document.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace heliograph::scene {

EditableDocument::EditableDocument(Json root, std::optional<std::size_t> shown, Warnings& warnings)
    : root_(std::move(root)), shown_(shown), warnings_(warnings) {
  if (shown_) root_["scene"] = *shown_;
}

EditableDocument::Json EditableDocument::take() {
  for (auto member = root_.begin(); member != root_.end();) {
    const bool empty = member->is_array() && member->empty();
    member = empty ? root_.erase(member) : std::next(member);
  }
  return std::move(root_);
}

EditableDocument::Json& EditableDocument::list(const char* name) {
  Json& list = root_[name];
  if (list.is_null()) list = Json::array();
  return list;
}

std::size_t EditableDocument::append(const char* name, Json item) {
  Json& items = list(name);
  items.push_back(std::move(item));
  return items.size() - 1;
}

// Without scenes all nodes without a parent are shown.
void EditableDocument::append_root(Json node) {
  const std::size_t index = append("nodes", std::move(node));
  if (shown_) list("scenes")[*shown_]["nodes"].push_back(index);
}

void EditableDocument::use(const std::string& extension) {
  list_extension("extensionsUsed", extension);
}

void EditableDocument::require(const std::string& extension) {
  use(extension);
  list_extension("extensionsRequired", extension);
}

void EditableDocument::list_extension(const char* where, const std::string& extension) {
  Json& listed = list(where);
  if (std::ranges::find(listed, Json(extension)) == listed.end()) listed.push_back(extension);
}

EditableDocument::Json& EditableDocument::extras(Json& object, const std::string& place) {
  Json& extras = object["extras"];
  if (extras.is_object()) return extras;
  if (!extras.is_null()) warn(place + ".extras is no object and was replaced");
  extras = Json::object();
  return extras;
}

void erase_within(nlohmann::json& object, const char* owner, const char* member) {
  const auto found = object.find(owner);
  if (found == object.end() || !found->is_object()) return;
  found->erase(member);
  if (found->empty()) object.erase(owner);
}

}  // namespace heliograph::scene
