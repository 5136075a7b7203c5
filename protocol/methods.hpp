#pragma once

#include <span>
#include <string_view>
#include <typeindex>
#include <vector>

#include "protocol/json/raw_json.hpp"
#include "protocol/result.hpp"

namespace heliograph::protocol {

/// The session that always exists and that is meant where none is named.
inline constexpr std::string_view main_session = "main";

/// One method of the protocol: the dispatcher takes calls by it, the OpenRPC document is made
/// from it.
struct MethodDescriptor {
  std::string_view name;
  std::string_view summary;
  std::type_index params;
  std::type_index result;
  /// Whether a call without id has an effect. Other calls without id ask for an answer that
  /// nobody would get and are dropped.
  bool may_be_notification;
  /// Whether it changes what all viewers of a session share.
  bool needs_control;
  /// Whether those may call it who may only watch: it changes nothing for others.
  bool read_only;
  /// What it may answer besides what every call may.
  std::vector<ErrorCode> errors;
  std::string_view example_params;  ///< JSON text
  std::string_view example_result;  ///< JSON text
  RawJson (*params_schema)();
  RawJson (*result_schema)();
  Result<void> (*check_params)(const RawJson&);
  Result<void> (*check_result)(const RawJson&);
};

/// A message the server sends unasked.
struct NotificationDescriptor {
  std::string_view name;
  std::string_view summary;
  std::type_index params;
  RawJson (*params_schema)();
};

std::span<const MethodDescriptor> methods();
std::span<const NotificationDescriptor> notifications();

/// The whole contract as an OpenRPC 1.3 document: methods with parameters, results, errors and
/// examples; the server's notifications stand under "x-notifications".
RawJson openrpc_document();

}  // namespace heliograph::protocol
