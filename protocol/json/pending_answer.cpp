#include "protocol/json/pending_answer.hpp"

#include <string>
#include <utility>

namespace heliograph::protocol {
namespace {

/// False where `used` would exceed `limit`; it is unchanged then.
bool take(std::atomic<std::size_t>& used, std::size_t limit, std::size_t bytes) {
  std::size_t before = used;
  do {
    if (before > limit || bytes > limit - before) return false;
  } while (!used.compare_exchange_weak(before, before + bytes));
  return true;
}

std::string mebibytes(std::size_t bytes) {
  return std::to_string(bytes >> 20) + " MiB";
}

}  // namespace

PendingAnswer::PendingAnswer(std::size_t limit, std::shared_ptr<AnswerMemory> all)
    : limit_(limit), all_(std::move(all)) {}

PendingAnswer::~PendingAnswer() {
  all_->used -= reserved_;
}

Result<void> PendingAnswer::reserve(std::size_t bytes) {
  if (!take(reserved_, limit_, bytes)) {
    return error::too_large({},
                            "the response would be too large; request less at once, or use "
                            "captures over HTTP",
                            mebibytes(limit_));
  }
  if (!take(all_->used, all_->limit, bytes)) {
    reserved_ -= bytes;
    return error::full("too many large responses are being made", mebibytes(all_->limit));
  }
  return {};
}

}  // namespace heliograph::protocol
