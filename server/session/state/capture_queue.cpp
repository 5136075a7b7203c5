#include "session/state/capture_queue.hpp"

#include <utility>

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

Result<void> CaptureQueue::check_capture_capacity() const {
  if (*pending_captures_ < limit_) return {};
  return error::full("too many captures are pending", std::to_string(limit_));
}

Result<void> CaptureQueue::check_probe_capacity() const {
  if (probes_.size() < limit_) return {};
  return error::full("too many picks and inspections are pending", std::to_string(limit_));
}

void CaptureQueue::add(CaptureRequest request) {
  ++*pending_captures_;
  request.pending =
      std::shared_ptr<void>(nullptr, [pending = pending_captures_](void*) { --*pending; });
  captures_.push_back(std::move(request));
}

std::vector<CaptureRequest> CaptureQueue::take_captures() {
  return std::exchange(captures_, {});
}

std::vector<Probe> CaptureQueue::take_probes() {
  return std::exchange(probes_, {});
}

std::optional<Ticket> CaptureQueue::first_ticket() const {
  std::optional<Ticket> first;
  for (const CaptureRequest& capture : captures_) first = earliest(first, capture.ticket);
  for (const Probe& probe : probes_) first = earliest(first, probe.ticket);
  return first;
}

}  // namespace heliograph::session
