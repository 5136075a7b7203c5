#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "protocol/messages/frame_header.hpp"
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
    {"UnknownMethod", ErrorCode::unknown_method, "Unknown method."},
    {"InvalidParams", ErrorCode::invalid_params, "A parameter is missing or invalid."},
    {"Internal", ErrorCode::internal, "The server failed."},
    {"Unauthenticated", ErrorCode::unauthenticated, "The caller is not authenticated."},
    {"Forbidden", ErrorCode::forbidden, "The caller is not allowed to do this."},
    {"RateLimited", ErrorCode::rate_limited, "Too many calls in a short time."},
    {"NotFound", ErrorCode::not_found, "The named object does not exist."},
    {"Conflict", ErrorCode::conflict, "The request conflicts with another change."},
    {"TooLarge", ErrorCode::too_large, "The message exceeds a limit."},
    {"Full", ErrorCode::full, "A limit of the server is reached."},
    {"NotReady", ErrorCode::not_ready, "A prerequisite of the call is missing."},
});

/// Errors that every method may return.
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
          {"description", "The content of error.data."},
          {"properties",
           {{"path", text("The parameter or setting that is wrong.")},
            {"reason", text("What is wrong with it.")},
            {"limit", text("The valid values.")}}},
          {"required", {"path", "reason"}}};
}

json frame_header() {
  json fields = json::array();
  for (const FrameHeaderField& field : frame_header_fields()) {
    fields.push_back({{"name", field.name},
                      {"offset", field.offset},
                      {"bytes", field.bytes},
                      {"description", field.meaning}});
  }
  return fields;
}

/// OpenRPC lists parameters individually; here they are the members of the params object.
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
          {"x-may-be-notification", method.may_be_notification()},
          {"x-needs-control", method.needs_control()},
          {"x-read-only", method.read_only()}};
}

}  // namespace

RawJson openrpc_document() {
  json document{
      {"openrpc", "1.3.2"},
      {"info",
       {{"title", "Heliograph"},
        {"version", HELIOGRAPH_VERSION},
        {"description",
         "Controls a render server. JSON-RPC 2.0 as text messages of a WebSocket at /ws "
         "(subprotocol heliograph.v1) or as POST /rpc."},
        {"license", {{"name", "MIT"}}}}},
      // Relative to the address of this document: the server need not know its own.
      {"servers", json::array({{{"name", "this server"}, {"url", "/rpc"}}})},
      {"methods", json::array()},
      {"x-notifications", json::array()},
      {"x-frame-header", frame_header()},
      {"components",
       {{"errors", errors_component()}, {"schemas", {{"ErrorData", error_data_schema()}}}}}};
  for (const MethodDescriptor& method : method_table()) {
    document["methods"].push_back(method_of(method));
  }
  for (const NotificationDescriptor& notification : notification_table()) {
    document["x-notifications"].push_back(
        {{"name", notification.name},
         {"summary", notification.summary},
         {"params", params_of(notification.params_schema().value())}});
  }
  return RawJson(std::move(document));
}

}  // namespace heliograph::protocol
