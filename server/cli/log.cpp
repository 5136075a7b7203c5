#include "cli/log.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "session/event_log.hpp"

namespace heliograph::cli {
namespace {

/// The message, followed by the fields "name=value".
std::vector<std::string_view> parts_of(const spdlog::details::log_msg& message) {
  std::string_view rest(message.payload.data(), message.payload.size());
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = std::min(rest.find(session::log_separator), rest.size());
    parts.push_back(rest.substr(0, end));
    if (end == rest.size()) return parts;
    rest.remove_prefix(end + 1);
  }
}

std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// The message and its fields as members of a JSON object.
class JsonMessage : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& out) override {
    const std::vector<std::string_view> parts = parts_of(message);
    std::string members = "\"message\":" + json_text(parts.front());
    for (const std::string_view part : std::span(parts).subspan(1)) {
      const std::size_t equals = std::min(part.find('='), part.size() - 1);
      members += "," + json_text(part.substr(0, equals)) + ":" + json_text(part.substr(equals + 1));
    }
    out.append(members.data(), members.data() + members.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<JsonMessage>();
  }
};

/// The message as one line of text, whatever it contains.
class TextMessage : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& out) override {
    std::string text(message.payload.data(), message.payload.size());
    for (char& c : text) {
      if (c == session::log_separator) c = ' ';
      if (static_cast<unsigned char>(c) < 0x20) c = '?';
    }
    out.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<TextMessage>();
  }
};

}  // namespace

void set_up_log(const LogOptions& options) {
  constexpr const char* name = "heliograph";
  spdlog::drop(name);  // a command may run another one
  auto logger = spdlog::stderr_color_mt(name);
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  if (options.format == "json") {
    formatter->add_flag<JsonMessage>('*');
    formatter->set_pattern(R"({"time":"%Y-%m-%dT%H:%M:%S.%e%z","level":"%l",%*})");
  } else {
    formatter->add_flag<TextMessage>('*');
    formatter->set_pattern("%H:%M:%S.%e %^%l%$ %*");
  }
  logger->set_formatter(std::move(formatter));
  logger->set_level(spdlog::level::from_str(options.level));
  spdlog::set_default_logger(std::move(logger));
}

}  // namespace heliograph::cli
