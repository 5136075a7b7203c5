#include "net/security/tokens.hpp"

#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace heliograph::net {
namespace {

constexpr std::size_t shortest_token = 8;
constexpr std::size_t longest_token = 256;
constexpr const char* rule = "a token needs at least 8 characters out of letters, digits and -._~";

bool is_acceptable(std::string_view token) {
  return token.size() >= shortest_token && token.size() <= longest_token &&
         std::all_of(token.begin(), token.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-' || c == '.' || c == '_' || c == '~';
         });
}

std::optional<Role> role_named(const std::string& name) {
  if (name == "control") return Role::control;
  if (name == "view") return Role::view;
  return std::nullopt;
}

}  // namespace

std::vector<Token> read_token_file(const std::filesystem::path& file) {
  std::ifstream lines(file);
  if (!lines) throw std::invalid_argument("the token file " + file.string() + " cannot be read");
  std::vector<Token> tokens;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string role;
    std::string text;
    std::string more;
    words >> role >> text >> more;
    if (role.empty() || role.starts_with('#')) continue;
    const std::optional<Role> known = role_named(role);
    if (!known || !is_acceptable(text) || !more.empty()) {
      throw std::invalid_argument(file.string() + ":" + std::to_string(number) +
                                  ": a line is \"control SECRET\" or \"view SECRET\"; " + rule);
    }
    tokens.push_back({.text = text, .role = *known});
  }
  if (tokens.empty()) throw std::invalid_argument(file.string() + " has no token");
  return tokens;
}

TokenSet::TokenSet(const std::vector<Token>& tokens) {
  for (const Token& token : tokens) {
    if (!is_acceptable(token.text)) throw std::invalid_argument(rule);
    if (role_of(token.text)) {
      throw std::invalid_argument("two tokens are the same");
    }
    tokens_.push_back({.digest = digest_of(token.text), .role = token.role});
  }
}

std::optional<Role> TokenSet::role_of(std::string_view candidate) const {
  const Digest presented = digest_of(candidate);
  std::optional<Role> role;
  for (const Entry& entry : tokens_) {
    if (CRYPTO_memcmp(presented.data(), entry.digest.data(), presented.size()) == 0)
      role = entry.role;
  }
  return role;
}

TokenSet::Digest TokenSet::digest_of(std::string_view text) {
  static_assert(SHA256_DIGEST_LENGTH == std::tuple_size_v<Digest>);
  Digest digest{};
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  return digest;
}

}  // namespace heliograph::net
