#include "session/state/reference_mode.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace heliograph::session {

using nlohmann::json;
using protocol::RawJson;
using protocol::ReferenceUse;

RawJson ReferenceMode::start_patch(const protocol::ReferenceStart& request) {
  json patch{{"reference", {{"use", "always"}, {"scope", protocol::enum_name(request.scope)}}},
             {"accumulation", {{"enabled", true}}}};
  if (request.samples) patch["accumulation"]["max_samples"] = *request.samples;
  return RawJson(std::move(patch));
}

void ReferenceMode::start(const protocol::Settings& before) {
  if (!restored_) restored_ = Restored{before.reference, before.accumulation};
  started_ = true;
}

RawJson ReferenceMode::stop_patch() const {
  json patch{{"reference", {{"use", "off"}}}};
  if (restored_) {
    const auto& [reference, accumulation] = *restored_;
    if (reference.use != ReferenceUse::always) {
      patch["reference"]["use"] = protocol::enum_name(reference.use);
    }
    patch["reference"]["scope"] = protocol::enum_name(reference.scope);
    patch["accumulation"] = {{"enabled", accumulation.enabled},
                             {"max_samples", accumulation.max_samples}};
  }
  return RawJson(std::move(patch));
}

void ReferenceMode::settings_changed(const protocol::Settings& settings) {
  if (settings.reference.use == ReferenceUse::always) return;
  restored_.reset();
  started_ = false;
}

void ReferenceMode::report_frame(std::uint64_t version, std::uint32_t samples, bool converged) {
  newest_frame_ = {.version = version, .samples = samples, .converged = converged};
}

protocol::ReferenceState ReferenceMode::state(const protocol::Settings& settings,
                                              std::uint64_t version, std::uint32_t rev) const {
  protocol::ReferenceState state{
      .shown = settings.reference.use == ReferenceUse::always,
      .scope = settings.reference.scope,
      .samples = 0,
      .target_samples = static_cast<std::uint32_t>(settings.accumulation.max_samples),
      .finished = false,
      .rev = rev};
  if (state.shown && newest_frame_.version == version) {
    state.samples = newest_frame_.samples;
    state.finished = newest_frame_.converged;
  }
  return state;
}

void ReferenceMode::copy_from(const ReferenceMode& other) {
  restored_ = other.restored_;
  started_ = false;
}

}  // namespace heliograph::session
