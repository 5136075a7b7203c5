#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace heliograph::protocol {

/// The numbers that reach a client as `error.code`: JSON-RPC 2.0's own and this protocol's.
enum class ErrorCode : int {
  parse_error = -32700,
  invalid_request = -32600,
  unknown_method = -32601,
  invalid_params = -32602,
  internal = -32603,
  unauthenticated = -32000,
  forbidden = -32001,
  rate_limited = -32002,
  not_found = -32004,
  conflict = -32009,
  too_large = -32013,
  full = -32029,
  not_ready = -32050,
};

/// Why a call was refused. `message` is one sentence for a person; `path`, `reason` and `limit`
/// are the parts a program (or a form) needs: which field, what is wrong, what would be right.
struct Error {
  ErrorCode code = ErrorCode::internal;
  std::string message;
  std::string path;
  std::string reason;
  std::string limit;

  bool operator==(const Error&) const = default;
};

namespace error {

/// An error of any code; the message is put together as "path reason (limit)".
Error make(ErrorCode code, std::string path, std::string reason, std::string limit = {});

/// A parameter that has the wrong type, is missing or lies outside its limits.
Error invalid(std::string path, std::string reason, std::string limit = {});
/// A well-named thing (scene, camera, buffer, session) that does not exist.
Error not_found(std::string path, std::string reason);
/// The request contradicts what happened meanwhile.
Error conflict(std::string path, std::string reason);
/// The message or what it asks for exceeds a fixed limit.
Error too_large(std::string path, std::string reason, std::string limit);
/// A limit on sessions, viewers or work is reached; trying later may succeed.
Error full(std::string reason, std::string limit = {});
/// What the call needs is not there yet (no scene loaded, first frame not rendered).
Error not_ready(std::string reason);
/// A fault of the server. Deliberately carries no detail: details belong in the log.
Error internal();

}  // namespace error

/// Either a value or the Error that says why there is none.
/// `value()`, `*` and `->` throw std::bad_variant_access when there is an error.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}

  bool has_value() const { return content_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  T& value() & { return std::get<0>(content_); }
  const T& value() const& { return std::get<0>(content_); }
  T&& value() && { return std::get<0>(std::move(content_)); }

  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const& { return std::get<1>(content_); }
  Error&& error() && { return std::get<1>(std::move(content_)); }

 private:
  std::variant<T, Error> content_;
};

/// Success, or the Error that says why not.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}

  bool has_value() const { return !error_; }
  explicit operator bool() const { return has_value(); }

  const Error& error() const& { return error_.value(); }
  Error&& error() && { return std::move(error_).value(); }

 private:
  std::optional<Error> error_;
};

}  // namespace heliograph::protocol
