#include "protocol/json/mcp_server.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "protocol/methods.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

/// The newest first.
constexpr std::array<std::string_view, 3> revisions{"2025-06-18", "2025-03-26", "2024-11-05"};

constexpr int method_not_found = -32601;
constexpr int invalid_params = -32602;

constexpr std::string_view instructions =
    "Heliograph renders glTF scenes. scene_list and scene_load choose one. frame_capture with "
    "format "
    "jpeg or png returns an image to look at; its buffers, such as gbuffer.instance and "
    "gbuffer.motion.view_z, show parts and distances. scene_pick tells what is at a point of the "
    "image, nodes_list the parts of the scene. Changes apply to this session, never to files.";

bool is_tool(const MethodDescriptor& method) {
  return method.call != Call::personal && method.name != methods::hello::name &&
         method.name != methods::rpc_discover::name;
}

std::string tool_name(const MethodDescriptor& method) {
  std::string name(method.name);
  std::ranges::replace(name, '.', '_');
  return name;
}

const MethodDescriptor* find_tool(std::string_view name) {
  for (const MethodDescriptor& method : method_table()) {
    if (is_tool(method) && tool_name(method) == name) return &method;
  }
  return nullptr;
}

json list_tools() {
  json tools = json::array();
  for (const MethodDescriptor& method : method_table()) {
    if (!is_tool(method)) continue;
    json schema = method.params_schema().value();
    schema["type"] = "object";
    tools.push_back({{"name", tool_name(method)},
                     {"description", method.summary},
                     {"inputSchema", std::move(schema)},
                     {"annotations", {{"readOnlyHint", method.call == Call::query}}}});
  }
  return {{"tools", std::move(tools)}};
}

json initialize(const json& params, std::string_view version) {
  std::string revision(revisions.front());
  const auto asked = params.find("protocolVersion");
  if (asked != params.end() && asked->is_string() && McpServer::knows(asked->get<std::string>())) {
    revision = *asked;
  }
  return {{"protocolVersion", revision},
          {"capabilities", {{"tools", json::object()}}},
          {"serverInfo", {{"name", "heliograph"}, {"version", version}}},
          {"instructions", instructions}};
}

json text_content(std::string text) {
  return {{"type", "text"}, {"text", std::move(text)}};
}

/// What models can look at.
std::optional<std::string> media_type(const json& result) {
  const auto format = result.find("format");
  const auto data = result.find("data");
  if (format == result.end() || data == result.end() || !data->is_string()) return std::nullopt;
  if (*format != "png" && *format != "jpeg" && *format != "webp") return std::nullopt;
  return "image/" + format->get<std::string>();
}

json tool_result(json result) {
  json content = json::array();
  if (const auto type = media_type(result)) {
    content.push_back(
        {{"type", "image"}, {"mimeType", *type}, {"data", std::move(result["data"])}});
    result.erase("data");
  }
  content.push_back(text_content(result.dump(-1, ' ', false, json::error_handler_t::replace)));
  return {{"content", std::move(content)}, {"isError", false}};
}

/// The result of a tool from the dispatcher's answer.
json tool_answer(const std::string& answer) {
  json response = json::parse(answer, nullptr, false);
  if (response.is_object() && response.contains("result")) {
    return tool_result(std::move(response["result"]));
  }
  std::string reason = "The server gave no answer.";
  if (response.is_object() && response.contains("error")) {
    reason = response["error"].value("message", reason);
  }
  return {{"content", json::array({text_content(std::move(reason))})}, {"isError", true}};
}

std::string response(const json& id, json result) {
  const json message{{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}};
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string failure(const json& id, int code, const std::string& reason) {
  const json message{
      {"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", reason}}}};
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

bool McpServer::knows(std::string_view revision) {
  return std::ranges::find(revisions, revision) != revisions.end();
}

void McpServer::handle(std::string_view text, const CallContext& context,
                       Dispatcher::Reply reply) const {
  const Result<RawJson> parsed = RawJson::parse(text);
  if (!parsed) return reply(error_answer(RawJson(), parsed.error()));
  const json& message = parsed->value();
  if (!message.is_object() || !message.contains("method") || !message["method"].is_string()) {
    // An answer of the client: nothing was asked.
    if (message.is_object() && (message.contains("result") || message.contains("error"))) {
      return reply({});
    }
    return reply(error_answer(RawJson(), error::make(ErrorCode::invalid_request, "method",
                                                     "must be the name of a method")));
  }
  if (!message.contains("id")) return reply({});
  const json id = message["id"], params = message.value("params", json::object());
  const std::string method = message["method"];
  if (!params.is_object()) {
    return reply(failure(id, invalid_params, "params: must be an object"));
  }
  if (method == "initialize") return reply(response(id, initialize(params, version_)));
  if (method == "ping") return reply(response(id, json::object()));
  if (method == "tools/list") return reply(response(id, list_tools()));
  if (method != "tools/call") {
    return reply(failure(id, method_not_found, "method: there is no " + method));
  }
  const auto name = params.find("name");
  const bool named = name != params.end() && name->is_string();
  const MethodDescriptor* const tool = named ? find_tool(name->get<std::string>()) : nullptr;
  if (!tool) {
    return reply(failure(id, invalid_params, "params.name: must be a tool of tools/list"));
  }
  const json call{{"jsonrpc", "2.0"},
                  {"id", 1},
                  {"method", tool->name},
                  {"params", params.value("arguments", json::object())}};
  dispatcher_.handle(call.dump(-1, ' ', false, json::error_handler_t::replace), context,
                     [id, reply = std::move(reply)](const std::string& answer) {
                       reply(response(id, tool_answer(answer)));
                     });
}

}  // namespace heliograph::protocol
