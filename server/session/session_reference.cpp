#include <nlohmann/json.hpp>

#include "protocol/jsonrpc.hpp"
#include "session/session.hpp"

// The path traced truth in a session.

namespace heliograph::session {

using nlohmann::json;
using protocol::ReferenceState;
using protocol::Result;

Result<ReferenceState> Session::start_reference(const protocol::ReferenceStart& request,
                                                const std::string& by) {
  int samples_before = 0;
  {
    const std::lock_guard lock(mutex_);
    if (const Result<void> there = require_scene(); !there) return there.error();
    samples_before = state_.settings.accumulation.max_samples;
  }
  json patch{{"reference", {{"use", "always"}, {"scope", protocol::enum_name(request.scope)}}},
             {"accumulation", {{"enabled", true}}}};
  if (request.samples) patch["accumulation"]["max_samples"] = *request.samples;
  if (const auto applied = patch_settings(protocol::RawJson(std::move(patch)), by); !applied) {
    return applied.error();
  }
  {
    const std::lock_guard lock(mutex_);
    if (!samples_before_reference_) samples_before_reference_ = samples_before;
    state_.keep_drawing = true;
    changed(false);
  }
  return reference();
}

Result<ReferenceState> Session::stop_reference(const std::string& by) {
  json patch{{"reference", {{"use", "never"}}}};
  {
    const std::lock_guard lock(mutex_);
    if (samples_before_reference_) {
      patch["accumulation"]["max_samples"] = *samples_before_reference_;
    }
    samples_before_reference_.reset();
    state_.keep_drawing = false;
  }
  if (const auto applied = patch_settings(protocol::RawJson(std::move(patch)), by); !applied) {
    return applied.error();
  }
  return reference();
}

ReferenceState Session::reference() const {
  const std::lock_guard lock(mutex_);
  const protocol::Settings& settings = state_.settings;
  ReferenceState state{.shown = settings.reference.use == protocol::ReferenceUse::always,
                       .scope = settings.reference.scope,
                       .samples = 0,
                       .wanted = static_cast<std::uint32_t>(settings.accumulation.max_samples),
                       .finished = false,
                       .rev = state_.rev};
  if (state.shown && newest_picture_.version == state_.version) {
    state.samples = newest_picture_.samples;
    state.finished = newest_picture_.converged;
  }
  return state;
}

void Session::report_picture(std::uint64_t version, std::uint32_t samples, bool converged) {
  const std::lock_guard lock(mutex_);
  newest_picture_ = {.version = version, .samples = samples, .converged = converged};
}

}  // namespace heliograph::session
