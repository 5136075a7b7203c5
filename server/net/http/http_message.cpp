#include "net/http/http_message.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>

#include "protocol/methods.hpp"

namespace heliograph::net {
namespace {

std::string decode(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const char* digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
      decoded.push_back(static_cast<char>(value));
      i += 2;
    } else {
      decoded.push_back(text[i] == '+' ? ' ' : text[i]);
    }
  }
  return decoded;
}

/// A number of decimal digits and nothing else.
std::optional<std::uint32_t> whole_number(std::string_view text) {
  std::uint32_t value = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return value;
}

}  // namespace

std::string_view HttpRequest::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? std::string_view() : std::string_view(found->second);
}

std::optional<std::string> HttpRequest::parameter(const std::string& name) const {
  const auto found = query.find(name);
  if (found == query.end()) return std::nullopt;
  return found->second;
}

HttpResponse text_response(int status, std::string_view text) {
  return {.status = status, .body = std::string(text) + "\n"};
}

HttpResponse json_response(std::string body) {
  return {.content_type = "application/json", .body = std::move(body)};
}

std::string session_of(const HttpRequest& request) {
  const auto entered = request.parameter("enter");
  if (entered) return *entered;
  return request.parameter("session").value_or(std::string(protocol::main_session));
}

std::map<std::string, std::string> parse_query(std::string_view query) {
  std::map<std::string, std::string> parameters;
  for (const std::string_view pair : header_elements(query, '&')) {
    const std::size_t equals = pair.find('=');
    const std::string_view value =
        equals == std::string_view::npos ? std::string_view() : pair.substr(equals + 1);
    parameters.insert_or_assign(decode(pair.substr(0, equals)), decode(value));
  }
  return parameters;
}

std::string encode_query(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    // RFC 3986 section 2.3, whatever the locale.
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.' || c == '_' || c == '~';
    if (plain) {
      encoded.push_back(c);
    } else {
      encoded += {'%', digits[byte >> 4], digits[byte & 15]};
    }
  }
  return encoded;
}

protocol::Result<std::optional<std::uint32_t>> number_parameter(const HttpRequest& request,
                                                                const std::string& name,
                                                                std::uint32_t least,
                                                                std::uint32_t most) {
  const std::optional<std::string> text = request.parameter(name);
  if (!text) return std::optional<std::uint32_t>();
  const std::optional<std::uint32_t> number = whole_number(*text);
  if (number && *number >= least && *number <= most) return number;
  return protocol::error::invalid(
      name, "must be an integer from " + std::to_string(least) + " to " + std::to_string(most));
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
  while (text.ends_with(' ') || text.ends_with('\t')) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> header_elements(std::string_view value, char separator) {
  std::vector<std::string_view> elements;
  while (!value.empty()) {
    const std::size_t end = std::min(value.find(separator), value.size());
    const std::string_view element = trimmed(value.substr(0, end));
    if (!element.empty()) elements.push_back(element);
    value.remove_prefix(std::min(end + 1, value.size()));
  }
  return elements;
}

}  // namespace heliograph::net
