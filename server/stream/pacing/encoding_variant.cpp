#include "stream/pacing/encoding_variant.hpp"

#include <algorithm>
#include <cmath>

namespace heliograph::stream {

using protocol::StreamCodec;

namespace {

bool cheaper(const Form& a, const Form& b) {
  const double bytes_a = relative_bytes(a);
  const double bytes_b = relative_bytes(b);
  return bytes_a != bytes_b ? bytes_a < bytes_b : a < b;
}

/// Keeps `count` of the sorted forms: the cheapest, then the dearest, then the middle.
std::vector<Form> keep(const std::vector<Form>& forms, std::size_t count) {
  if (forms.size() <= count) return forms;
  if (count == 1) return {forms.front()};
  if (count == 2) return {forms.front(), forms.back()};
  return {forms.front(), forms[forms.size() / 2], forms.back()};
}

}  // namespace

double relative_bytes(const Form& form) {
  // Measured on rendered scenes: a step of 10 in quality is a factor of about 1.35.
  const double by_quality = std::exp(0.03 * (form.quality - 80));
  // Smaller pictures hold more detail in each pixel.
  const double by_size = std::pow(form.scale / 100.0, 1.6);
  return by_quality * by_size;
}

std::vector<Form> reduce_forms(std::vector<Form> wanted) {
  std::sort(wanted.begin(), wanted.end(), cheaper);
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  if (wanted.size() <= max_forms) return wanted;
  std::vector<Form> jpeg;
  std::vector<Form> video;
  for (const Form& form : wanted) {
    (form.codec == StreamCodec::jpeg ? jpeg : video).push_back(form);
  }
  const std::size_t videos = std::min(video.size(), jpeg.empty() ? max_forms : max_forms - 1);
  jpeg = keep(jpeg, max_forms - videos);
  video = keep(video, videos);
  jpeg.insert(jpeg.end(), video.begin(), video.end());
  std::sort(jpeg.begin(), jpeg.end(), cheaper);
  return jpeg;
}

Form assigned_form(const std::vector<Form>& forms, const Form& wanted) {
  std::optional<Form> cheapest;
  std::optional<Form> best;
  for (const Form& form : forms) {
    if (form.codec != wanted.codec) continue;
    if (!cheapest || cheaper(form, *cheapest)) cheapest = form;
    if (!cheaper(wanted, form) && (!best || cheaper(*best, form))) best = form;
  }
  return best ? *best : *cheapest;
}

}  // namespace heliograph::stream
