#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "protocol/messages/session_messages.hpp"
#include "protocol/methods.hpp"
#include "protocol/result.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

struct ErrorDescription {
  std::string_view name;
  ErrorCode code;
  std::string_view message;
};

constexpr auto error_descriptions = std::to_array<ErrorDescription>({
    {"ParseError", ErrorCode::parse_error, "The text is not JSON."},
    {"InvalidRequest", ErrorCode::invalid_request, "The JSON is not a request."},
    {"UnknownMethod", ErrorCode::unknown_method, "No method has this name."},
    {"InvalidParams", ErrorCode::invalid_params, "A parameter is missing or not acceptable."},
    {"Internal", ErrorCode::internal, "The server failed."},
    {"Unauthenticated", ErrorCode::unauthenticated, "The caller has not shown who it is."},
    {"Forbidden", ErrorCode::forbidden, "The caller may not do this."},
    {"RateLimited", ErrorCode::rate_limited, "Too many calls in too little time."},
    {"NotFound", ErrorCode::not_found, "What was named does not exist."},
    {"Conflict", ErrorCode::conflict, "The request contradicts what happened meanwhile."},
    {"TooLarge", ErrorCode::too_large, "The message exceeds a limit."},
    {"Full", ErrorCode::full, "The server has no room for more."},
    {"NotReady", ErrorCode::not_ready, "What the call needs is not there yet."},
});

/// Errors that any call may get.
constexpr std::array usual_errors{ErrorCode::invalid_params, ErrorCode::not_found,
                                  ErrorCode::too_large,      ErrorCode::not_ready,
                                  ErrorCode::rate_limited,   ErrorCode::internal};

json parsed(std::string_view text) {
  return json::parse(text);
}

json errors_component() {
  json errors = json::object();
  for (const ErrorDescription& description : error_descriptions) {
    errors[std::string(description.name)] = {{"code", static_cast<int>(description.code)},
                                             {"message", description.message}};
  }
  return errors;
}

json error_data_schema() {
  const auto text = [](const char* description) {
    return json{{"type", "string"}, {"description", description}};
  };
  return {{"type", "object"},
          {"description", "What error.data holds."},
          {"properties",
           {{"path", text("The parameter or setting at fault.")},
            {"reason", text("What is wrong with it.")},
            {"limit", text("What would be right.")}}},
          {"required", {"path", "reason"}}};
}

/// OpenRPC lists parameters one by one; ours are the members of the params object.
json params_of(const json& schema) {
  json params = json::array();
  const json required = schema.value("required", json::array());
  for (const auto& [name, member] : schema.at("properties").items()) {
    const bool needed = std::find(required.begin(), required.end(), name) != required.end();
    params.push_back({{"name", name},
                      {"description", member.at("description")},
                      {"required", needed},
                      {"schema", member}});
  }
  // Required parameters must come first.
  std::stable_partition(params.begin(), params.end(),
                        [](const json& param) { return param.at("required") == true; });
  return params;
}

json example_of(const MethodDescriptor& method) {
  json params = json::array();
  const json values = parsed(method.example_params);
  for (const auto& [name, value] : values.items()) {
    params.push_back({{"name", name}, {"value", value}});
  }
  return {{"name", std::string(method.name) + " example"},
          {"params", std::move(params)},
          {"result", {{"name", "result"}, {"value", parsed(method.example_result)}}}};
}

json errors_of(const MethodDescriptor& method) {
  json errors = json::array();
  for (const ErrorDescription& description : error_descriptions) {
    const auto is_it = [&](ErrorCode code) { return code == description.code; };
    if (!std::ranges::any_of(usual_errors, is_it) && !std::ranges::any_of(method.errors, is_it)) {
      continue;
    }
    errors.push_back({{"$ref", "#/components/errors/" + std::string(description.name)}});
  }
  return errors;
}

json method_of(const MethodDescriptor& method) {
  return {{"name", method.name},
          {"summary", method.summary},
          {"paramStructure", "by-name"},
          {"params", params_of(method.params_schema().value())},
          {"result", {{"name", "result"}, {"schema", method.result_schema().value()}}},
          {"errors", errors_of(method)},
          {"examples", json::array({example_of(method)})},
          {"x-may-be-notification", method.may_be_notification},
          {"x-needs-control", method.needs_control},
          {"x-read-only", method.read_only}};
}

}  // namespace

RawJson openrpc_document() {
  json document{
      {"openrpc", "1.3.2"},
      {"info",
       {{"title", "Heliograph"},
        {"version", HELIOGRAPH_VERSION},
        {"description",
         "Steers a render server. JSON-RPC 2.0 as text messages of a WebSocket at /ws "
         "(subprotocol heliograph.v1) or as POST /rpc."},
        {"license", {{"name", "MIT"}}}}},
      // Relative to where this document was fetched: the server need not know its own address.
      {"servers", json::array({{{"name", "this server"}, {"url", "/rpc"}}})},
      {"methods", json::array()},
      {"x-notifications", json::array()},
      {"components",
       {{"errors", errors_component()}, {"schemas", {{"ErrorData", error_data_schema()}}}}}};
  for (const MethodDescriptor& method : methods()) {
    document["methods"].push_back(method_of(method));
  }
  for (const NotificationDescriptor& notification : notifications()) {
    document["x-notifications"].push_back(
        {{"name", notification.name},
         {"summary", notification.summary},
         {"params", params_of(notification.params_schema().value())}});
  }
  return RawJson(std::move(document));
}

}  // namespace heliograph::protocol
