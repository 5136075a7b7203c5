#include "net/http/request_head.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "net/http/http_message.hpp"

namespace heliograph::net {
namespace {

constexpr std::string_view line_end = "\r\n";
constexpr std::string_view head_end = "\r\n\r\n";

/// Whether a carriage return or line feed is not part of a pair. One at the end may still become
/// one.
bool has_bare_line_end(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n' && (i == 0 || text[i - 1] != '\r')) return true;
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] != '\n') return true;
  }
  return false;
}

/// A host name or address with an optional port, or nothing. What is refused here would belong to
/// a list, a path or a user, RFC 3986 section 3.2.
bool is_host(std::string_view value) {
  return std::all_of(value.begin(), value.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-._~:[]%!$&'()*+;=").find(c) != std::string_view::npos;
  });
}

bool is_number(std::string_view value) {
  return !value.empty() &&
         std::all_of(value.begin(), value.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The headers that decide who is asked, and where the request ends.
class FramingHeaders {
 public:
  void add(std::string_view name, std::string_view value) {
    const std::string key = lower(name);
    if (key == "host") {
      ++hosts_;
      valid_host_ &= is_host(value);
    } else if (key == "content-length") {
      ++lengths_;
      valid_length_ &= is_number(value);
    } else if (key == "transfer-encoding") {
      ++encodings_;
      chunked_ &= lower(value) == "chunked";
    }
  }

  std::string_view fault(bool http_1_1) const {
    if (hosts_ > 1) return "The request has more than one Host.";
    if (hosts_ == 0 && http_1_1) return "The request has no Host.";
    if (!valid_host_) return "Host must be a name or an address.";
    if (lengths_ > 1) return "The request has more than one Content-Length.";
    if (!valid_length_) return "Content-Length must be a number.";
    if (encodings_ == 0) return {};
    if (lengths_ > 0) return "The request has both Content-Length and Transfer-Encoding.";
    if (encodings_ > 1 || !chunked_) return "Transfer-Encoding must be chunked.";
    return http_1_1 ? std::string_view() : "Transfer-Encoding needs HTTP/1.1.";
  }

 private:
  int hosts_ = 0;
  int lengths_ = 0;
  int encodings_ = 0;
  bool valid_host_ = true;
  bool valid_length_ = true;
  bool chunked_ = true;
};

/// `head` without the empty line at its end.
std::string_view fault_of_lines(std::string_view head) {
  const std::size_t end_of_first = std::min(head.find(line_end), head.size());
  const bool http_1_1 = head.substr(0, end_of_first).ends_with(" HTTP/1.1");
  head.remove_prefix(std::min(end_of_first + line_end.size(), head.size()));
  FramingHeaders headers;
  while (!head.empty()) {
    const std::string_view line = head.substr(0, head.find(line_end));
    head.remove_prefix(std::min(line.size() + line_end.size(), head.size()));
    if (line.starts_with(' ') || line.starts_with('\t')) {
      return "A header must be on one line.";
    }
    const std::size_t colon = std::min(line.find(':'), line.size());
    headers.add(line.substr(0, colon), trimmed(line.substr(std::min(colon + 1, line.size()))));
  }
  return headers.fault(http_1_1);
}

}  // namespace

RequestHead examine_request_head(std::string_view received) {
  const std::size_t end = received.find(head_end);
  const bool whole = end != std::string_view::npos;
  RequestHead head{.length = whole ? end + head_end.size() : 0, .fault = {}};
  if (has_bare_line_end(received.substr(0, whole ? head.length : received.size()))) {
    head.fault = "Lines must end with CR and LF.";
  } else if (whole) {
    head.fault = fault_of_lines(received.substr(0, end));
  }
  return head;
}

bool is_plain_chunk_extension(std::string_view extension) {
  return std::none_of(extension.begin(), extension.end(), [](char c) {
    return c != '\t' && std::iscntrl(static_cast<unsigned char>(c)) != 0;
  });
}

}  // namespace heliograph::net
