#pragma once

#include <cstddef>
#include <vector>

namespace heliograph::stream {

/// Pictures are encoded once per class, so that many viewers cost few encodings.
inline constexpr std::size_t max_quality_classes = 3;

/// The qualities to encode for viewers who ask for `wanted`: theirs if they are few enough, else
/// the lowest, the highest and the one in the middle. Ascending, without repetition.
std::vector<int> quality_classes(std::vector<int> wanted);

/// The index of the class nearest to `quality`, the lower of two equally near. `classes` is not
/// empty.
std::size_t nearest_class(const std::vector<int>& classes, int quality);

}  // namespace heliograph::stream
