#include "session/event_log.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>

namespace heliograph::session {
namespace {

std::string harmless(std::string_view text) {
  std::string result(text);
  std::replace_if(
      result.begin(), result.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return result;
}

std::string entry(const LogSubject& subject, std::string_view text) {
  std::string result = harmless(text);
  const auto add = [&](std::string_view name, std::string_view value) {
    if (value.empty()) return;
    result += log_separator;
    result += name;
    result += '=';
    result += harmless(value);
  };
  add("session", subject.session);
  add("viewer", subject.viewer);
  add("client", subject.client);
  return result;
}

}  // namespace

void log_info(const LogSubject& subject, std::string_view text) {
  spdlog::info("{}", entry(subject, text));
}

void log_warning(const LogSubject& subject, std::string_view text) {
  spdlog::warn("{}", entry(subject, text));
}

void log_error(const LogSubject& subject, std::string_view text) {
  spdlog::error("{}", entry(subject, text));
}

}  // namespace heliograph::session
