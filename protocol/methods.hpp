#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/json/raw_json.hpp"
#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"

namespace heliograph::protocol {

/// The session that always exists, and the default where no session is named.
inline constexpr std::string_view main_session = "main";

/// A type per method, from methods/*.def: its parameters, its result, its name.
namespace methods {
#define METHOD(tag, method_name, ParamsType, ResultType, ...) \
  struct tag {                                                \
    using Params = ParamsType;                                \
    using Result = ResultType;                                \
    static constexpr std::string_view name = method_name;     \
  };
#include "protocol/methods/methods.def"
}  // namespace methods

/// A type per notification, a message that the server sends without a request.
namespace notifications {
#define NOTIFICATION(tag, notification_name, ParamsType, ...)   \
  struct tag {                                                  \
    using Params = ParamsType;                                  \
    static constexpr std::string_view name = notification_name; \
  };
#include "protocol/methods/methods.def"
}  // namespace notifications

/// JSON of a method's messages. Defined in json/codec.hpp and instantiated in methods/*_codec.cpp,
/// so that only those files compile the JSON library's templates.
template <class Method>
struct MethodCodec {
  /// Ignores unknown members. A missing, ill-typed or out-of-range member gives
  /// ErrorCode::invalid_params with its path ("cameras[2].eye"), the reason and the limit.
  static Result<typename Method::Params> read_params(const RawJson& json);
  /// A sentence about each of the ignored members; the first few of them.
  static std::vector<std::string> unknown_params(const RawJson& json);
  static RawJson write_result(const typename Method::Result& result);
  static Result<void> check_params(const RawJson& json);
  static Result<void> check_result(const RawJson& json);
  /// JSON Schema 2020-12.
  static RawJson params_schema();
  static RawJson result_schema();
};

template <class Notification>
struct NotificationCodec {
  static RawJson write_params(const typename Notification::Params& params);
  static RawJson params_schema();
};

/// Which callers may call a method.
enum class Call {
  query,       ///< changes nothing; allowed for all callers
  personal,    ///< changes something for its caller only; allowed for all callers
  command,     ///< changes the session for all its viewers; needs control of it
  movement,    ///< moves the camera: a command, but for viewers that have a camera of their own
  annotation,  ///< measures or annotates: a command, but for all where the server allows it
  management,  ///< about sessions; needs a control token, but not control of the session
};

/// One method of the protocol: the dispatcher looks up calls in the table of these, and the OpenRPC
/// document is generated from it.
struct MethodDescriptor {
  std::string_view name;
  std::string_view summary;
  Call call;
  std::vector<ErrorCode> errors;    ///< beside those that every method may return
  std::string_view example_params;  ///< JSON text
  std::string_view example_result;  ///< JSON text
  RawJson (*params_schema)();
  RawJson (*result_schema)();
  Result<void> (*check_params)(const RawJson&);
  Result<void> (*check_result)(const RawJson&);

  /// Whether a call without id has an effect. Queries without id are dropped: there is no answer to
  /// send.
  bool may_be_notification() const { return call != Call::query; }
  /// Whether it changes what the viewers of a session share.
  bool needs_control() const {
    return call == Call::command || call == Call::movement || call == Call::annotation;
  }
  /// Whether read-only viewers may call it.
  bool read_only() const { return call == Call::query || call == Call::personal; }
};

struct NotificationDescriptor {
  std::string_view name;
  std::string_view summary;
  RawJson (*params_schema)();
};

std::span<const MethodDescriptor> method_table();
std::span<const NotificationDescriptor> notification_table();

/// The protocol as an OpenRPC 1.3 document: methods with parameters, results, errors and examples;
/// notifications under "x-notifications".
RawJson openrpc_document();

}  // namespace heliograph::protocol
