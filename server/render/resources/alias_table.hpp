#pragma once

#include <cstdint>
#include <vector>

namespace heliograph::render {

/// One of as many slots as there are items, all equally likely.
struct Alias {
  float threshold;     // below it a number in [0, 1) stays with the item of the slot's own number
  std::uint32_t item;  // which it takes otherwise
};

/// Draws items in proportion to their weights, at least one of which is above 0, in one look-up
/// (Walker 1977, Vose 1991).
std::vector<Alias> make_alias_table(std::vector<double> weights);

}  // namespace heliograph::render
