#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "protocol/json/pending_answer.hpp"
#include "protocol/methods.hpp"
#include "protocol/result.hpp"

namespace heliograph::protocol {

/// The caller of a method. The transport makes one per message; handlers copy what they need later.
struct CallContext {
  std::string viewer;  ///< the viewer's id; empty for callers without a stream
  /// The session of a caller that is no viewer; a viewer's session is known by its id.
  std::string session{main_session};
  bool view_only = false;  ///< the caller's token does not allow control
  /// The answer to the message; null: of any size, and always waited for.
  std::shared_ptr<PendingAnswer> answer = nullptr;
};

/// Completes a call, on any thread, at once or later; only the first result is used. If every copy
/// is destroyed without a result, the caller gets ErrorCode::not_ready.
template <class Response>
using Completion = std::function<void(Result<Response>)>;

template <class Request, class Response>
using Handler = std::function<void(Request, const CallContext&, Completion<Response>)>;

/// The result of a call with the member `warnings`, if there are any.
RawJson with_warnings(RawJson result, const std::vector<std::string>& warnings);

/// The error for callers whose token does not allow control.
Error read_only_token();

/// The response text of an error; `id` is null where the id of the call could not be read.
std::string error_answer(const RawJson& id, const Error& error);

struct DispatchLimits {
  std::size_t max_message_bytes = 64 * 1024;
  std::size_t max_depth = 64;  ///< of nested arrays and objects, checked before parsing
  std::size_t max_batch = 32;
};

/// JSON-RPC 2.0: text in, typed handlers, text out; independent of the transport. All functions
/// except `handle` are for set-up; after it, `handle` may be called from any thread.
class Dispatcher {
 public:
  /// Receives the response text, exactly once per message; empty if there is no response. Runs on
  /// the thread of the last completion.
  using Reply = std::function<void(std::string)>;

  /// Serves the given methods, by default those of the protocol. Handles rpc.discover and
  /// settings.schema itself where they are among them.
  explicit Dispatcher(DispatchLimits limits = {},
                      std::span<const MethodDescriptor> served = method_table());

  /// Sets the handler of a method, such as methods::camera_get.
  /// @throws std::logic_error if the method is not among those served or has a handler already
  template <class Method>
  void add(Handler<typename Method::Params, typename Method::Result> handler);

  /// Methods without a handler; they return ErrorCode::unknown_method.
  std::vector<std::string_view> missing_handlers() const;

  /// Called with the method and the exception's text when a handler throws. The caller gets only
  /// ErrorCode::internal.
  void on_handler_failure(std::function<void(std::string_view, std::string_view)> report);

  /// Called before every call of a method; an error becomes the result of the call.
  using Gate = std::function<Result<void>(const MethodDescriptor&, const CallContext&)>;
  void set_gate(Gate gate) { gate_ = std::move(gate); }

  /// Handles one message: a request, a notification or a batch. Does not throw.
  void handle(std::string_view text, const CallContext& context, Reply reply) const;

 private:
  using RawCompletion = std::function<void(Result<RawJson>)>;
  using RawHandler = std::function<void(const RawJson&, const CallContext&, RawCompletion)>;
  struct Entry {
    const MethodDescriptor* method;
    RawHandler handler;
  };
  class Exchange;

  void add_raw(std::string_view name, RawHandler handler);
  Result<RawJson> read_message(std::string_view text) const;
  void handle_one(const RawJson& request, const CallContext& context,
                  const std::shared_ptr<Exchange>& exchange) const;
  void invoke(const Entry& entry, const RawJson& params, const CallContext& context,
              RawCompletion done) const;
  Result<const Entry*> find(std::string_view method) const;

  DispatchLimits limits_;
  std::map<std::string_view, Entry> entries_;
  std::function<void(std::string_view, std::string_view)> report_failure_;
  Gate gate_;
};

template <class Method>
void Dispatcher::add(Handler<typename Method::Params, typename Method::Result> handler) {
  add_raw(Method::name, [handler = std::move(handler)](
                            const RawJson& json, const CallContext& context, RawCompletion done) {
    Result<typename Method::Params> params = MethodCodec<Method>::read_params(json);
    if (!params) return done(std::move(params).error());
    handler(*std::move(params), context,
            [done = std::move(done), warnings = MethodCodec<Method>::unknown_params(json)](
                Result<typename Method::Result> result) {
              if (!result) return done(std::move(result).error());
              RawJson written = MethodCodec<Method>::write_result(*result);
              // A document is not the server's to add to.
              constexpr bool document = std::is_same_v<typename Method::Result, RawJson>;
              done(document ? written : with_warnings(std::move(written), warnings));
            });
  });
}

std::string make_raw_notification(std::string_view method, const RawJson& params);

/// The text of a notification to a client, such as notifications::camera_changed.
template <class Notification>
std::string make_notification(const typename Notification::Params& params) {
  return make_raw_notification(Notification::name,
                               NotificationCodec<Notification>::write_params(params));
}

}  // namespace heliograph::protocol
