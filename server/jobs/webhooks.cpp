// How clients are told that a job has ended.
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "jobs/job_queue.hpp"
#include "protocol/json/codec.hpp"

namespace heliograph::jobs {
namespace {

constexpr int most_deliveries = 10;
constexpr double first_pause = 5.0;            // seconds, doubled after each attempt
constexpr double webhook_failure_pause = 5.0;  // of the database, seconds
constexpr double longest_wait = 3600.0;        // the clock may be set

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string signature_of(const std::string& body, const std::string& secret) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  HMAC(EVP_sha256(), secret.data(), static_cast<int>(secret.size()),
       reinterpret_cast<const unsigned char*>(body.data()), body.size(), digest.data(), &size);
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text = "sha256=";
  for (unsigned int i = 0; i < size; ++i) text += {digits[digest[i] >> 4], digits[digest[i] & 15]};
  return text;
}

}  // namespace

/// Until the next one is due, or the end of a job.
void JobQueue::wait_for_webhook(std::unique_lock<std::mutex>& lock) {
  const std::optional<double> next = store_.next_webhook();
  if (!next) return webhook_event_.wait(lock);
  const double seconds = std::clamp(*next - seconds_now(), 0.0, longest_wait);
  webhook_event_.wait_for(lock, std::chrono::duration<double>(seconds));
}

void JobQueue::run_webhooks() {
  while (true) {
    try {
      std::optional<DueWebhook> due;
      std::optional<protocol::JobInfo> job;
      {
        std::unique_lock lock(mutex_);
        if (stopping_) return;
        due = store_.due_webhook(seconds_now());
        if (due) {
          job = store_.find(due->id);
        } else {
          wait_for_webhook(lock);
        }
      }
      if (!due) continue;
      const std::string body = protocol::encode(*job).text();
      const bool delivered =
          options_.deliver({due->url, body, signature_of(body, options_.webhook_secret)});
      const bool last = due->attempts + 1 >= most_deliveries;
      if (!delivered && last) spdlog::warn("jobs: the webhook of job {} was given up", due->id);
      std::optional<double> again;
      if (!delivered && !last) again = seconds_now() + first_pause * std::exp2(due->attempts);
      const std::lock_guard lock(mutex_);
      store_.webhook_sent(due->id, again);
    } catch (const std::exception& failure) {
      spdlog::error("jobs: {}", failure.what());
      if (!wait(webhook_event_, webhook_failure_pause)) return;
    }
  }
}

}  // namespace heliograph::jobs
