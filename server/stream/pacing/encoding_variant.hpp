#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/messages/stream_kinds.hpp"

namespace heliograph::stream {

/// How a picture is encoded: viewers who want the same share the bytes.
struct Form {
  protocol::StreamCodec codec = protocol::StreamCodec::jpeg;
  int scale = 100;   // percent of the picture's width and height
  int quality = 80;  // 1 to 100

  friend auto operator<=>(const Form&, const Form&) = default;
};

/// Where a frame stands in a video. A frame that is not a key frame needs the one before it.
struct VideoPosition {
  std::uint64_t video = 0;  // unique to each run of an encoder
  std::uint32_t index = 0;

  bool follows(const VideoPosition& other) const {
    return video == other.video && index == other.index + 1;
  }
};

/// A moving picture is encoded at most so often, however many viewers there are.
inline constexpr std::size_t max_forms = 3;

/// Roughly how many bytes a picture takes in this form, as a part of JPEG's at quality 80.
double relative_bytes(const Form& form);

/// The forms to encode for viewers who want `wanted`: theirs if they are few enough, else the
/// cheapest, the dearest and the one in the middle of each codec, with one left for JPEG if
/// somebody needs that. Ascending, without repetition.
std::vector<Form> reduce_forms(std::vector<Form> wanted);

/// What a viewer who wants `wanted` gets of `forms`: the dearest one of its codec that is no dearer
/// than it asked for, else the cheapest. `forms` holds one of its codec.
Form assigned_form(const std::vector<Form>& forms, const Form& wanted);

}  // namespace heliograph::stream
