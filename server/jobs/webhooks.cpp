// How clients are told that a job has ended.
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "jobs/job_queue.hpp"
#include "protocol/json/codec.hpp"

namespace heliograph::jobs {
namespace {

constexpr int most_deliveries = 10;
constexpr double first_pause = 5.0;  // seconds, doubled after each attempt
constexpr double check_interval = 5.0;

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
          webhook_event_.wait_for(lock, std::chrono::duration<double>(check_interval));
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
      if (!wait(webhook_event_, check_interval)) return;
    }
  }
}

}  // namespace heliograph::jobs
