#include "protocol/result.hpp"

namespace heliograph::protocol::error {

Error make(ErrorCode code, std::string path, std::string reason, std::string limit) {
  std::string message = path.empty() ? reason : path + ": " + reason;
  if (!limit.empty()) message += " (" + limit + ")";
  return Error{code, std::move(message), std::move(path), std::move(reason), std::move(limit)};
}

Error invalid(std::string path, std::string reason, std::string limit) {
  return make(ErrorCode::invalid_params, std::move(path), std::move(reason), std::move(limit));
}

Error not_found(std::string path, std::string reason) {
  return make(ErrorCode::not_found, std::move(path), std::move(reason));
}

Error conflict(std::string path, std::string reason) {
  return make(ErrorCode::conflict, std::move(path), std::move(reason));
}

Error too_large(std::string path, std::string reason, std::string limit) {
  return make(ErrorCode::too_large, std::move(path), std::move(reason), std::move(limit));
}

Error full(std::string reason, std::string limit) {
  return make(ErrorCode::full, {}, std::move(reason), std::move(limit));
}

Error not_ready(std::string reason) {
  return make(ErrorCode::not_ready, {}, std::move(reason));
}

Error internal() {
  return make(ErrorCode::internal, {}, "internal error");
}

}  // namespace heliograph::protocol::error
