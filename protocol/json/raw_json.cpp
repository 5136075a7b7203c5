#include "protocol/json/raw_json.hpp"

#include <nlohmann/json.hpp>

namespace heliograph::protocol {

RawJson::RawJson() : value_(std::make_shared<const nlohmann::json>()) {}

RawJson::RawJson(nlohmann::json value)
    : value_(std::make_shared<const nlohmann::json>(std::move(value))) {}

Result<RawJson> RawJson::parse(std::string_view text) {
  nlohmann::json value = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (value.is_discarded()) {
    return error::make(ErrorCode::parse_error, {}, "the text is not valid JSON");
  }
  return RawJson(std::move(value));
}

std::string RawJson::text() const {
  return value_->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool RawJson::operator==(const RawJson& other) const {
  return *value_ == *other.value_;
}

}  // namespace heliograph::protocol
