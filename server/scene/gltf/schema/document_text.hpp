#pragma once

#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

namespace heliograph::scene {

/// Writes JSON: objects and arrays are opened and closed by the caller, commas are set here.
class DocumentText {
 public:
  void open(char bracket) {
    separate();
    text_ += bracket;
    first_ = true;
  }
  void close(char bracket) {
    text_ += bracket;
    first_ = false;
  }
  void name(std::string_view member) {
    write(member);
    text_ += ':';
    first_ = true;
  }
  void raw(std::string_view json) {
    separate();
    text_ += json;
  }
  void number(double value) { raw_number(value); }
  void integer(std::uint64_t value) { raw_number(value); }
  /// Makes the integer just written one with a fraction: of zero.
  void make_real() { text_ += ".0"; }
  void write(std::string_view text) {
    separate();
    for (const char c : text) {
      if (static_cast<unsigned char>(c) < 0x20 || c == '"' || c == '\\') {
        text_ += nlohmann::json(text).dump();
        return;
      }
    }
    text_ += '"';
    text_ += text;
    text_ += '"';
  }

  /// A position to come back to with `rewind`.
  std::pair<std::size_t, bool> mark() const { return {text_.size(), first_}; }
  void rewind(const std::pair<std::size_t, bool>& mark) {
    text_.resize(mark.first);
    first_ = mark.second;
  }
  std::string take() { return std::move(text_); }

 private:
  template <typename T>
  void raw_number(T value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    raw({digits, static_cast<std::size_t>(end - digits)});
  }
  void separate() {
    if (!first_) text_ += ',';
    first_ = false;
  }

  std::string text_;
  bool first_ = true;
};

}  // namespace heliograph::scene
