#include "stream/pacing/variant_planner.hpp"

#include <algorithm>

namespace heliograph::stream {

using protocol::StreamCodec;

namespace {

void add(std::vector<FormRequest>& requests, const FormRequest& request) {
  const auto same = std::find_if(requests.begin(), requests.end(), [&](const FormRequest& other) {
    return other.form == request.form;
  });
  if (same == requests.end()) requests.push_back(request);
}

}  // namespace

FormPlanner::Plan FormPlanner::plan(const std::vector<FormWish>& wishes,
                                    Clock::time_point now) const {
  std::vector<Form> wanted;
  for (const FormWish& wish : wishes) wanted.push_back(wish.form);
  const std::vector<Form> forms = reduce_forms(std::move(wanted));

  Plan plan;
  for (const FormWish& wish : wishes) plan.assigned.push_back(assigned_form(forms, wish.form));
  for (const Form& form : forms) {
    bool ready_in_step = false;
    bool ready_lost = false;
    bool any_in_step = false;
    double budget = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < wishes.size(); ++i) {
      if (plan.assigned[i] != form) continue;
      const bool follows = form.codec == StreamCodec::jpeg || in_step(wishes[i], form);
      budget = std::min(budget, wishes[i].budget);
      any_in_step |= follows;
      ready_in_step |= follows && wishes[i].ready;
      ready_lost |= !follows && wishes[i].ready;
    }
    const auto video = videos_.find(form);
    const bool key_allowed =
        !any_in_step || video == videos_.end() || now >= video->second.key_at + least_key_interval;
    const bool key = ready_lost && key_allowed;
    if (ready_in_step || key) add(plan.requests, {.form = form, .key = key, .max_bytes = budget});
    if (ready_lost && !key) add(plan.requests, {.form = stand_in(form)});
  }
  return plan;
}

void FormPlanner::published(const EncodedFrame& frame, Clock::time_point now) {
  if (!frame.video) return;
  Video& video = videos_[frame.form];
  video.newest = *frame.video;
  if (frame.header.flags & protocol::frame_flag::key) video.key_at = now;
}

Form FormPlanner::stand_in(const Form& video) {
  return {.codec = StreamCodec::jpeg, .scale = video.scale, .quality = std::min(video.quality, 75)};
}

bool FormPlanner::in_step(const FormWish& wish, const Form& form) const {
  const auto video = videos_.find(form);
  return wish.decoder && video != videos_.end() &&
         wish.decoder->video == video->second.newest.video &&
         wish.decoder->index == video->second.newest.index;
}

}  // namespace heliograph::stream
