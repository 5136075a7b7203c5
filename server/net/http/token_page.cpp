#include "net/http/token_page.hpp"

#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "stream/encoders/base64.hpp"
#include "web_client/embedded_assets.hpp"

namespace heliograph::net {
namespace {

constexpr std::string_view message_of_file =
    R"(<p id="message">This server needs an access token.</p>)";

std::string_view header_of(const HttpResponse& response, std::string_view name) {
  const auto found = std::ranges::find(response.headers, name, &Headers::value_type::first);
  return found == response.headers.end() ? std::string_view() : std::string_view(found->second);
}

std::string message_for(const HttpResponse& refusal) {
  if (refusal.status == 429) {
    return "Too many wrong tokens. Try again in " + std::string(header_of(refusal, "Retry-After")) +
           " s.";
  }
  return header_of(refusal, "WWW-Authenticate").find("invalid_token") == std::string_view::npos
             ? ""
             : "This token is not valid. Check it, or ask for a new one.";
}

std::string html_escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    if (c == '<' || c == '>' || c == '&' || c == '"') {
      html += "&#" + std::to_string(static_cast<int>(c)) + ";";
    } else {
      html += c;
    }
  }
  return html;
}

void replace_part(std::string& text, std::string_view part, const std::string& by) {
  const std::size_t at = text.find(part);
  if (at != std::string::npos) text.replace(at, part.size(), by);
}

/// The style sheet within the page, and nothing else, CSP level 3.
std::string policy_for(std::string_view page) {
  constexpr std::string_view begin = "<style>";
  const std::size_t start = page.find(begin) + begin.size();
  const std::string_view style = page.substr(start, page.find("</style>") - start);
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> hash{};
  SHA256(reinterpret_cast<const std::uint8_t*>(style.data()), style.size(), hash.data());
  return "default-src 'none'; style-src 'sha256-" + stream::base64_encode(hash) +
         "'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'";
}

}  // namespace

bool asks_for_page(const HttpRequest& request) {
  return is_page(request.path) && (request.method == "GET" || request.method == "HEAD") &&
         request.header("accept").find("text/html") != std::string_view::npos;
}

HttpResponse token_page(const HttpRequest& request, HttpResponse refusal) {
  const web::Asset* file = web::find_asset("token.html");
  if (!file) return refusal;
  std::string page(file->bytes.begin(), file->bytes.end());
  if (const std::string message = message_for(refusal); !message.empty()) {
    replace_part(page, message_of_file,
                 R"(<p id="message" class="bad" role="alert">)" + message + "</p>");
  }
  std::string parameters;
  for (const auto& [name, value] : request.query) {
    if (name == "token") continue;
    parameters += R"(<input type="hidden" name=")" + html_escaped(name) + R"(" value=")" +
                  html_escaped(value) + R"(" />)";
  }
  replace_part(page, "<!--parameters-->", parameters);
  refusal.headers.emplace_back("Content-Security-Policy", policy_for(page));
  refusal.headers.emplace_back("X-Content-Type-Options", "nosniff");
  refusal.headers.emplace_back("Referrer-Policy", "no-referrer");
  refusal.headers.emplace_back("Cache-Control", "no-store");
  refusal.content_type = "text/html; charset=utf-8";
  refusal.body = std::move(page);
  return refusal;
}

}  // namespace heliograph::net
