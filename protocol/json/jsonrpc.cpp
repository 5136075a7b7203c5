#include "protocol/json/jsonrpc.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "protocol/json/suggestions.hpp"
#include "protocol/settings/settings_json.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

/// Depth of nested arrays and objects, found without parsing; brackets in strings are skipped. The
/// result for invalid JSON is arbitrary: the parser refuses it afterwards.
std::size_t nesting_depth(std::string_view text) {
  std::size_t depth = 0;
  std::size_t deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return deepest;
}

std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string result_text(const json& id, const RawJson& result) {
  return dump({{"jsonrpc", "2.0"}, {"id", id}, {"result", result.value()}});
}

Error invalid_request(std::string path, std::string reason, std::string limit = {}) {
  return error::make(ErrorCode::invalid_request, std::move(path), std::move(reason),
                     std::move(limit));
}

/// The members of a JSON-RPC request.
struct ParsedCall {
  std::optional<json> id;  ///< absent: a notification
  std::string method;
  RawJson params;
};

Result<ParsedCall> read_call(const json& request) {
  const auto version = request.find("jsonrpc");
  if (version == request.end() || *version != "2.0") {
    return invalid_request("jsonrpc", "must be \"2.0\"");
  }
  const auto method = request.find("method");
  if (method == request.end() || !method->is_string()) {
    return invalid_request("method", "must be a string");
  }
  ParsedCall call;
  call.method = method->get<std::string>();
  if (const auto id = request.find("id"); id != request.end()) call.id = *id;

  const auto params = request.find("params");
  const bool none = params == request.end() || (params->is_array() && params->empty());
  if (!none && !params->is_structured()) {
    return invalid_request("params", "must be an object");
  }
  call.params = RawJson(none ? json::object() : *params);
  return call;
}

/// The id to answer with, as far as one can be made out; null otherwise.
json id_of(const json& request) {
  const auto id = request.find("id");
  if (id == request.end() || !(id->is_string() || id->is_number())) return nullptr;
  return *id;
}

bool valid_id(const json& request) {
  const auto id = request.find("id");
  return id == request.end() || id->is_string() || id->is_number() || id->is_null();
}

}  // namespace

RawJson with_warnings(RawJson result, const std::vector<std::string>& warnings) {
  if (warnings.empty() || !result.value().is_object()) return result;
  json warned = result.value();
  warned["warnings"] = warnings;
  return RawJson(std::move(warned));
}

std::string error_answer(const RawJson& id, const Error& error) {
  json data{{"path", error.path}, {"reason", error.reason}};
  if (!error.limit.empty()) data["limit"] = error.limit;
  return dump({{"jsonrpc", "2.0"},
               {"id", id.value()},
               {"error",
                {{"code", static_cast<int>(error.code)},
                 {"message", error.message},
                 {"data", std::move(data)}}}});
}

/// Gathers the answers to one message and replies when the last one is there.
class Dispatcher::Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  Exchange(bool batch, Reply reply) : batch_(batch), reply_(std::move(reply)) {}

  /// A completion that answers the call with this id. Answers keep the order of their calls.
  RawCompletion expect(json id) {
    std::size_t slot = 0;
    {
      const std::lock_guard lock(mutex_);
      slot = answers_.size();
      answers_.emplace_back();
      ++open_;
    }
    auto pending = std::make_shared<Pending>(shared_from_this(), slot, std::move(id));
    return [pending = std::move(pending)](Result<RawJson> result) { pending->finish(result); };
  }

  /// No more calls will be expected. Until then no reply is sent.
  void close() { settle(std::nullopt, {}); }

 private:
  /// One pending call. Its destructor completes it, so that every caller gets a response.
  class Pending {
   public:
    Pending(std::shared_ptr<Exchange> exchange, std::size_t slot, json id)
        : exchange_(std::move(exchange)), slot_(slot), id_(std::move(id)) {}
    Pending(const Pending&) = delete;
    Pending& operator=(const Pending&) = delete;
    ~Pending() {
      finish([] { return Result<RawJson>(error::not_ready("the server dropped the call")); });
    }

    void finish(const Result<RawJson>& result) noexcept {
      finish([&]() -> const Result<RawJson>& { return result; });
    }

   private:
    template <class MakeResult>
    void finish(const MakeResult& make_result) noexcept {
      if (finished_.exchange(true)) return;
      try {
        exchange_->settle(slot_, text_of(make_result));
      } catch (...) {
        // Out of memory or a failed transport: no receiver is left.
      }
    }

    /// An error where there is no memory for a large result: its caller waits.
    template <class MakeResult>
    std::string text_of(const MakeResult& make_result) const {
      try {
        const Result<RawJson>& result = make_result();
        return result ? result_text(id_, *result) : error_answer(RawJson(id_), result.error());
      } catch (const std::bad_alloc&) {
        return error_answer(RawJson(id_), error::internal());
      }
    }

    std::shared_ptr<Exchange> exchange_;
    std::size_t slot_;
    json id_;
    std::atomic<bool> finished_ = false;
  };

  void settle(std::optional<std::size_t> slot, std::string answer) {
    Reply reply;
    {
      const std::lock_guard lock(mutex_);
      if (slot) answers_[*slot] = std::move(answer);
      if (--open_ > 0) return;
      reply = std::move(reply_);
    }
    reply(joined());
  }

  std::string joined() {
    if (!batch_) return answers_.empty() ? std::string() : std::move(answers_.front());
    if (answers_.empty()) return {};
    // Answers may be large: each is freed once it is copied, and the text does not grow by copies.
    std::size_t length = answers_.size() + 1;
    for (const std::string& answer : answers_) length += answer.size();
    std::string text;
    text.reserve(length);
    for (std::string& answer : answers_) {
      text += text.empty() ? '[' : ',';
      text += std::exchange(answer, {});
    }
    return text += ']';
  }

  const bool batch_;
  Reply reply_;
  std::mutex mutex_;
  std::vector<std::string> answers_;
  std::size_t open_ = 1;  // for close()
};

Dispatcher::Dispatcher(DispatchLimits limits, std::span<const MethodDescriptor> served)
    : limits_(limits) {
  for (const MethodDescriptor& method : served) entries_[method.name] = {&method, {}};
  if (entries_.contains(methods::rpc_discover::name)) {
    add<methods::rpc_discover>(
        [](Empty, const CallContext&, auto done) { done(openrpc_document()); });
  }
  if (entries_.contains(methods::settings_schema::name)) {
    add<methods::settings_schema>(
        [](Empty, const CallContext&, auto done) { done(RawJson(settings_schema())); });
  }
}

void Dispatcher::add_raw(std::string_view name, RawHandler handler) {
  const auto found = entries_.find(name);
  if (found == entries_.end()) {
    throw std::logic_error("there is no method " + std::string(name));
  }
  Entry& entry = found->second;
  if (entry.handler) throw std::logic_error(std::string(name) + " has two handlers");
  entry.handler = std::move(handler);
}

std::vector<std::string_view> Dispatcher::missing_handlers() const {
  std::vector<std::string_view> names;
  for (const auto& [name, entry] : entries_) {
    if (!entry.handler) names.push_back(name);
  }
  return names;
}

void Dispatcher::on_handler_failure(
    std::function<void(std::string_view, std::string_view)> report) {
  report_failure_ = std::move(report);
}

void Dispatcher::handle(std::string_view text, const CallContext& context, Reply reply) const {
  try {
    const Result<RawJson> message = read_message(text);
    if (!message) return reply(error_answer(RawJson(nullptr), message.error()));

    const json& value = message->value();
    const auto exchange = std::make_shared<Exchange>(value.is_array(), reply);
    if (value.is_array()) {
      for (const json& request : value) handle_one(RawJson(request), context, exchange);
    } else {
      handle_one(*message, context, exchange);
    }
    exchange->close();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& failure) {
    if (report_failure_) report_failure_("reply", failure.what());
  }
}

Result<RawJson> Dispatcher::read_message(std::string_view text) const {
  if (text.size() > limits_.max_message_bytes) {
    return error::too_large({}, "the message is too long",
                            std::to_string(limits_.max_message_bytes) + " bytes");
  }
  if (nesting_depth(text) > limits_.max_depth) {
    return error::too_large({}, "the message is nested too deeply",
                            std::to_string(limits_.max_depth) + " levels");
  }
  Result<RawJson> message = RawJson::parse(text);
  if (!message) return message;
  const json& value = message->value();
  if (value.is_array() && value.empty()) return invalid_request({}, "the batch is empty");
  if (value.is_array() && value.size() > limits_.max_batch) {
    return error::too_large({}, "the batch has too many calls", std::to_string(limits_.max_batch));
  }
  return message;
}

void Dispatcher::handle_one(const RawJson& request, const CallContext& context,
                            const std::shared_ptr<Exchange>& exchange) const {
  const json& value = request.value();
  if (!value.is_object()) {
    return exchange->expect(nullptr)(invalid_request({}, "a call must be an object"));
  }
  if (!valid_id(value)) {
    return exchange->expect(nullptr)(invalid_request("id", "must be a string, a number or null"));
  }
  const Result<ParsedCall> call = read_call(value);
  if (!call) return exchange->expect(id_of(value))(call.error());

  const Result<const Entry*> entry = find(call->method);
  if (!call->id) {
    if (entry && (*entry)->method->may_be_notification()) {
      invoke(**entry, call->params, context, [](const Result<RawJson>&) {});
    }
    return;
  }
  RawCompletion done = exchange->expect(*call->id);
  if (!entry) return done(entry.error());
  invoke(**entry, call->params, context, std::move(done));
}

Error read_only_token() {
  return error::make(ErrorCode::forbidden, "method", "the client's token is read-only");
}

void Dispatcher::invoke(const Entry& entry, const RawJson& params, const CallContext& context,
                        RawCompletion done) const {
  const auto fail = [&](const char* what) {
    if (report_failure_) report_failure_(entry.method->name, what);
    done(error::internal());
  };
  if (!params.value().is_object()) {
    return done(error::invalid("params", "must be an object", "parameters are passed by name"));
  }
  // Whether the camera is the caller's own, and who may annotate, is known to the gate.
  const Call call = entry.method->call;
  const bool gated = gate_ && (call == Call::movement || call == Call::annotation);
  if (context.view_only && !entry.method->read_only() && !gated) {
    return done(read_only_token());
  }
  try {
    if (gate_) {
      if (Result<void> passed = gate_(*entry.method, context); !passed) {
        return done(std::move(passed).error());
      }
    }
    entry.handler(params, context, done);
  } catch (const std::exception& failure) {
    fail(failure.what());
  } catch (...) {
    fail("an exception of unknown type");
  }
}

Result<const Dispatcher::Entry*> Dispatcher::find(std::string_view method) const {
  const auto found = entries_.find(method);
  if (found != entries_.end() && found->second.handler) return &found->second;

  std::vector<std::string_view> names;
  for (const auto& [name, entry] : entries_) {
    if (entry.handler) names.push_back(name);
  }
  return error::make(ErrorCode::unknown_method, "method",
                     "unknown method" + suggestion(method, names), "see rpc.discover");
}

std::string make_raw_notification(std::string_view method, const RawJson& params) {
  return dump({{"jsonrpc", "2.0"}, {"method", method}, {"params", params.value()}});
}

}  // namespace heliograph::protocol
