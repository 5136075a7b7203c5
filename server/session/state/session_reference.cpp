#include <nlohmann/json.hpp>

#include "protocol/json/jsonrpc.hpp"
#include "session/state/session.hpp"

// The path traced truth in a session.

namespace heliograph::session {

using nlohmann::json;
using protocol::ReferenceState;
using protocol::Result;

Result<ReferenceState> Session::start_reference(const protocol::ReferenceStart& request,
                                                const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  const BeforeReference before = before_reference_.value_or(
      BeforeReference{state_.settings.reference, state_.settings.accumulation});
  json patch{{"reference", {{"use", "always"}, {"scope", protocol::enum_name(request.scope)}}},
             {"accumulation", {{"enabled", true}}}};
  if (request.samples) patch["accumulation"]["max_samples"] = *request.samples;
  if (const auto applied = patch_locked(protocol::RawJson(std::move(patch)), by); !applied) {
    return applied.error();
  }
  before_reference_ = before;
  state_.keep_drawing = true;
  changed(false);
  return reference_message();
}

Result<ReferenceState> Session::stop_reference(const std::string& by) {
  const std::lock_guard lock(mutex_);
  json patch{{"reference", {{"use", "never"}}}};
  if (before_reference_) {
    const auto& [reference, accumulation] = *before_reference_;
    if (reference.use == protocol::ReferenceUse::when_static)
      patch["reference"]["use"] = "when_static";
    patch["reference"]["scope"] = protocol::enum_name(reference.scope);
    patch["accumulation"] = {{"enabled", accumulation.enabled},
                             {"max_samples", accumulation.max_samples}};
  }
  if (const auto applied = patch_locked(protocol::RawJson(std::move(patch)), by); !applied) {
    return applied.error();
  }
  return reference_message();
}

ReferenceState Session::reference() const {
  const std::lock_guard lock(mutex_);
  return reference_message();
}

ReferenceState Session::reference_message() const {
  const protocol::Settings& settings = state_.settings;
  ReferenceState state{
      .shown = settings.reference.use == protocol::ReferenceUse::always,
      .scope = settings.reference.scope,
      .samples = 0,
      .target_samples = static_cast<std::uint32_t>(settings.accumulation.max_samples),
      .finished = false,
      .rev = state_.rev};
  if (state.shown && newest_frame_.version == state_.version) {
    state.samples = newest_frame_.samples;
    state.finished = newest_frame_.converged;
  }
  return state;
}

void Session::report_frame(std::uint64_t version, std::uint32_t samples, bool converged) {
  const std::lock_guard lock(mutex_);
  newest_frame_ = {.version = version, .samples = samples, .converged = converged};
}

}  // namespace heliograph::session
