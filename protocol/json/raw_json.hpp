#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "protocol/result.hpp"

namespace heliograph::protocol {

/// An immutable JSON value that can be a member of a message without including the JSON library:
/// settings trees, schemas, documents. Cheap to copy (shared). Default: null.
class RawJson {
 public:
  RawJson();
  explicit RawJson(nlohmann::json value);

  /// The value of `text`, or an ErrorCode::parse_error.
  static Result<RawJson> parse(std::string_view text);

  const nlohmann::json& value() const { return *value_; }
  /// Compact JSON text. Bytes that are not UTF-8 (file names can hold any) become U+FFFD.
  std::string text() const;

  bool operator==(const RawJson& other) const;

 private:
  std::shared_ptr<const nlohmann::json> value_;
};

}  // namespace heliograph::protocol
