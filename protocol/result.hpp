#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace heliograph::protocol {

/// Values of `error.code`: those of JSON-RPC 2.0 and those of this protocol.
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

/// Why a call failed. `message` is one sentence for the user; `path`, `reason` and `limit` are its
/// parts for programs: the field, what is wrong, and which values are valid.
struct Error {
  ErrorCode code = ErrorCode::internal;
  std::string message;
  std::string path;
  std::string reason;
  std::string limit;

  bool operator==(const Error&) const = default;
};

namespace error {

/// An error of any code; its message is "path: reason (limit)".
Error make(ErrorCode code, std::string path, std::string reason, std::string limit = {});

/// A parameter that has the wrong type, is missing or lies outside its limits.
Error invalid(std::string path, std::string reason, std::string limit = {});
/// A name (of a scene, camera, buffer, session) that does not exist.
Error not_found(std::string path, std::string reason);
/// The request conflicts with another change.
Error conflict(std::string path, std::string reason);
/// The message or the requested work exceeds a fixed limit.
Error too_large(std::string path, std::string reason, std::string limit);
/// A limit on sessions, viewers or work is reached; a retry may succeed.
Error full(std::string reason, std::string limit = {});
/// A prerequisite is missing (no scene loaded, first frame not rendered).
Error not_ready(std::string reason);
/// A fault of the server. Carries no detail on purpose: details are in the log.
Error internal();

}  // namespace error

/// Either a value or an Error. `value()`, `*` and `->` throw std::bad_variant_access if there is an
/// error.
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

/// Success or an Error.
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
