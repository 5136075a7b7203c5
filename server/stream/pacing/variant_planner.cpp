#include "stream/pacing/variant_planner.hpp"

#include <algorithm>

namespace heliograph::stream {

using protocol::StreamCodec;

namespace {

void add(std::vector<VariantRequest>& requests, const VariantRequest& request) {
  const auto same =
      std::find_if(requests.begin(), requests.end(),
                   [&](const VariantRequest& other) { return other.variant == request.variant; });
  if (same == requests.end()) requests.push_back(request);
}

}  // namespace

VariantPlanner::Plan VariantPlanner::plan(const std::vector<RequestedVariant>& requests,
                                          Clock::time_point now) const {
  std::vector<EncodingVariant> requested;
  for (const RequestedVariant& request : requests) requested.push_back(request.variant);
  const std::vector<EncodingVariant> variants = reduce_variants(std::move(requested));

  Plan plan;
  for (const RequestedVariant& request : requests)
    plan.assigned.push_back(assigned_variant(variants, request.variant));
  for (const EncodingVariant& variant : variants) {
    bool ready_in_step = false;
    bool ready_lost = false;
    bool any_in_step = false;
    double budget = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < requests.size(); ++i) {
      if (plan.assigned[i] != variant) continue;
      const bool follows = variant.codec == StreamCodec::jpeg || in_step(requests[i], variant);
      budget = std::min(budget, requests[i].budget);
      any_in_step |= follows;
      ready_in_step |= follows && requests[i].ready;
      ready_lost |= !follows && requests[i].ready;
    }
    const auto video = videos_.find(variant);
    const bool key_allowed =
        !any_in_step || video == videos_.end() || now >= video->second.key_at + min_key_interval;
    const bool key = ready_lost && key_allowed;
    if (ready_in_step || key)
      add(plan.requests, {.variant = variant, .key = key, .max_bytes = budget});
    if (ready_lost && !key) add(plan.requests, {.variant = jpeg_fallback(variant)});
  }
  return plan;
}

void VariantPlanner::published(const EncodedFrame& frame, Clock::time_point now) {
  if (!frame.video) return;
  Video& video = videos_[frame.variant];
  video.newest = *frame.video;
  if (frame.header.flags & protocol::frame_flag::key) video.key_at = now;
}

EncodingVariant VariantPlanner::jpeg_fallback(const EncodingVariant& video) {
  return {.codec = StreamCodec::jpeg, .scale = video.scale, .quality = std::min(video.quality, 75)};
}

bool VariantPlanner::in_step(const RequestedVariant& request,
                             const EncodingVariant& variant) const {
  const auto video = videos_.find(variant);
  return request.decoder && video != videos_.end() &&
         request.decoder->video == video->second.newest.video &&
         request.decoder->index == video->second.newest.index;
}

}  // namespace heliograph::stream
