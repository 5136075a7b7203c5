#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

#include "protocol/json/codec.hpp"
#include "protocol/methods.hpp"
#include "protocol/result.hpp"

namespace heliograph::protocol {

/// Who calls. Made by the transport for every message; handlers copy what they need later.
struct CallContext {
  std::string viewer;  ///< the viewer's id; empty for callers that watch no stream
  /// Where a caller that is no viewer calls; where a viewer is, is known by its id.
  std::string session{main_session};
  bool view_only = false;  ///< may watch but not steer
};

/// Takes the answer of a call: from any thread, at once or later; only the first one counts. If
/// every copy is destroyed unanswered, the caller gets ErrorCode::not_ready.
template <class Response>
using Completion = std::function<void(Result<Response>)>;

template <class Request, class Response>
using Handler = std::function<void(Request, const CallContext&, Completion<Response>)>;

/// The text that answers a call with an error; `id` is null where the call's could not be read.
std::string error_answer(const RawJson& id, const Error& error);

struct DispatchLimits {
  std::size_t max_message_bytes = 64 * 1024;
  std::size_t max_depth = 64;  ///< of nested arrays and objects, checked before anything is built
  std::size_t max_batch = 32;
};

/// JSON-RPC 2.0: text in, typed handlers, text out. Knows no transport. All
/// functions but `handle` belong to set-up; after it, `handle` may be called from any thread.
class Dispatcher {
 public:
  /// Receives the answer's text, exactly once per message; empty if there is nothing to answer.
  /// Runs on the thread of the last completion.
  using Reply = std::function<void(std::string)>;

  /// Serves the given methods, by default those of the protocol, plus rpc.discover and
  /// settings.schema, which it answers itself where they are among them.
  explicit Dispatcher(DispatchLimits limits = {},
                      std::span<const MethodDescriptor> methods = protocol::methods());

  /// Sets the handler of a declared method. Throws std::logic_error if no method has this name and
  /// these types, or if it has a handler already.
  template <class Request, class Response>
  void add(std::string_view name, Handler<Request, Response> handler);

  /// Declared methods that nobody has added a handler for; they answer ErrorCode::unknown_method.
  std::vector<std::string_view> missing_handlers() const;

  /// Called with the method and the exception's text when a handler throws. The caller only
  /// learns ErrorCode::internal.
  void on_handler_failure(std::function<void(std::string_view, std::string_view)> report);

  /// Asked before every call of a declared method; an error is the call's answer.
  using Gate = std::function<Result<void>(const MethodDescriptor&, const CallContext&)>;
  void set_gate(Gate gate) { gate_ = std::move(gate); }

  /// Takes one message: a request, a notification or a batch. Does not throw.
  void handle(std::string_view text, const CallContext& context, Reply reply) const;

 private:
  using RawCompletion = std::function<void(Result<RawJson>)>;
  using RawHandler = std::function<void(const RawJson&, const CallContext&, RawCompletion)>;
  struct Entry {
    const MethodDescriptor* method;
    RawHandler handler;
  };
  class Exchange;

  void add_raw(std::string_view name, std::type_index request, std::type_index response,
               RawHandler handler);
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

template <class Request, class Response>
void Dispatcher::add(std::string_view name, Handler<Request, Response> handler) {
  add_raw(name, typeid(Request), typeid(Response),
          [handler = std::move(handler)](const RawJson& params, const CallContext& context,
                                         RawCompletion done) {
            Result<Request> request = decode<Request>(params);
            if (!request) return done(std::move(request).error());
            handler(*std::move(request), context,
                    [done = std::move(done)](Result<Response> response) {
                      if (!response) return done(std::move(response).error());
                      done(encode<Response>(*response));
                    });
          });
}

std::string make_raw_notification(std::string_view method, const RawJson& params);

/// The text of a notification to a client.
template <class Params>
std::string make_notification(std::string_view method, const Params& params) {
  return make_raw_notification(method, encode<Params>(params));
}

}  // namespace heliograph::protocol
