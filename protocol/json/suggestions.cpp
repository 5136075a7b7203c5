#include "protocol/json/suggestions.hpp"

#include <algorithm>
#include <cstddef>

namespace heliograph::protocol {
namespace {

/// Levenshtein's distance: insertions, deletions and substitutions between two names.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string suggestion(std::string_view name, const std::vector<std::string_view>& candidates) {
  // A name far longer than any candidate is no typing error, and comparing it would cost time in
  // proportion to what a client sends.
  constexpr std::size_t longest = 128;
  if (name.empty() || name.size() > longest) return {};

  std::size_t least = name.size() / 3 + 2;
  std::string_view nearest;
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  if (nearest.empty()) return {};
  return "; did you mean " + std::string(nearest) + "?";
}

}  // namespace heliograph::protocol
