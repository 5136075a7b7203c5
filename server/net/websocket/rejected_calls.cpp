#include "net/websocket/rejected_calls.hpp"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "protocol/json/jsonrpc.hpp"

namespace heliograph::net {
namespace {

using nlohmann::json;

constexpr std::size_t most_ids = protocol::DispatchLimits().max_batch;

/// Collects the ids of a message's calls while it is parsed.
class IdReader : public nlohmann::json_sax<json> {
 public:
  std::vector<json> ids;
  bool batch = false;

  bool null() override { return value(nullptr); }
  bool boolean(bool) override { return value(nullptr); }
  bool number_integer(number_integer_t number) override { return value(number); }
  bool number_unsigned(number_unsigned_t number) override { return value(number); }
  bool number_float(number_float_t number, const string_t&) override { return value(number); }
  bool string(string_t& text) override { return value(text); }
  bool binary(binary_t&) override { return value(nullptr); }
  bool start_object(std::size_t) override {
    is_call_ |= depth_ == (batch ? 1u : 0u);
    return open();
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override {
    if (depth_ == 0) batch = true;
    return open();
  }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    of_id_ = depth_ == (batch ? 2u : 1u) && name == "id";
    wants_answer_ |= of_id_;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

  /// Whether a message that was parsed to its end is a notification.
  bool notifies() const { return is_call_ && !wants_answer_; }

 private:
  bool open() {
    of_id_ = false;
    ++depth_;
    return true;
  }
  bool close() {
    --depth_;
    return true;
  }
  /// False ends the parsing.
  bool value(json id) {
    if (!std::exchange(of_id_, false)) return true;
    ids.push_back(std::move(id));
    return batch && ids.size() < most_ids;
  }

  std::size_t depth_ = 0;
  bool of_id_ = false;
  bool is_call_ = false;
  bool wants_answer_ = false;
};

}  // namespace

std::string reject_calls(std::string_view message, const protocol::Error& error) {
  IdReader reader;
  const bool whole = json::sax_parse(message.begin(), message.end(), &reader);
  if (whole && reader.notifies()) return {};
  if (reader.ids.empty()) return protocol::error_answer(protocol::RawJson(nullptr), error);
  std::string answers;
  for (json& id : reader.ids) {
    if (!answers.empty()) answers += ',';
    answers += protocol::error_answer(protocol::RawJson(std::move(id)), error);
  }
  return reader.batch ? '[' + answers + ']' : answers;
}

protocol::Error too_many_messages() {
  return {.code = protocol::ErrorCode::rate_limited,
          .message = "too many messages on this connection",
          .path = {},
          .reason = "too many messages",
          .limit = "500 in a second"};
}

protocol::Error answer_too_large(std::string limit) {
  return protocol::error::too_large(
      {},
      "the response does not fit behind the responses that were not yet read; request "
      "less at once, or use captures over HTTP",
      std::move(limit));
}

}  // namespace heliograph::net
