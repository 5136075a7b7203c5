#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "scene/warnings.hpp"

namespace heliograph::scene {

/// A whole glTF document that is being changed. Objects are found by index, since references into a
/// list end when it grows.
class EditableDocument {
 public:
  using Json = nlohmann::json;

  /// `shown`: the scene that new nodes belong to; nothing where the document has none.
  EditableDocument(Json root, std::optional<std::size_t> shown, Warnings& warnings);

  Json& root() { return root_; }
  /// The document, without arrays that have stayed empty.
  Json take();
  /// An array of the document, which is made where it is missing.
  Json& list(const char* name);
  Json& node(std::size_t index) { return list("nodes")[index]; }
  /// Appends to an array of the document. @return the index
  std::size_t append(const char* name, Json item);
  /// Appends a node to the scene that is shown.
  void append_root(Json node);
  /// Lists an extension as used.
  void use(const std::string& extension);
  /// Lists one also as required: without it the document cannot be read (glTF 3.12).
  void require(const std::string& extension);
  /// The "extras" of an object, which may be of any type: another one gives way, with a warning.
  Json& extras(Json& object, const std::string& place);
  void warn(std::string text) { warnings_.add(std::move(text)); }

 private:
  void list_extension(const char* where, const std::string& extension);

  Json root_;
  const std::optional<std::size_t> shown_;
  Warnings& warnings_;
};

/// Removes a member of "extensions" or "extras", and these where nothing else is in them.
void erase_within(nlohmann::json& object, const char* owner, const char* member);

}  // namespace heliograph::scene
