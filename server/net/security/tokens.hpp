#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace heliograph::net {

/// What a client may do: only view, or control as well.
enum class Role { view, control };

struct Token {
  std::string text;
  Role role = Role::control;
};

/// The tokens of a file: lines of "control SECRET" or "view SECRET"; empty lines and those that
/// begin with # are skipped. @throws std::invalid_argument with file and line
std::vector<Token> read_token_file(const std::filesystem::path& file);

/// Recognises tokens in a time that depends neither on where the first difference is nor on which
/// of them it is: digests are compared, each with all.
class TokenSet {
 public:
  /// @throws std::invalid_argument for a token that is short or does not fit into headers
  explicit TokenSet(const std::vector<Token>& tokens);

  bool empty() const { return tokens_.empty(); }
  std::optional<Role> role_of(std::string_view candidate) const;

 private:
  using Digest = std::array<unsigned char, 32>;
  struct Entry {
    Digest digest;
    Role role;
  };
  static Digest digest_of(std::string_view text);

  std::vector<Entry> tokens_;
};

}  // namespace heliograph::net
