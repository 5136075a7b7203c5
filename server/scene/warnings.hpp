#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace heliograph::scene {

/// Warnings about skipped or repaired objects: unique, and limited in number.
class Warnings {
 public:
  void add(std::string text) {
    if (texts_.size() >= max_count) return;
    if (std::find(texts_.begin(), texts_.end(), text) == texts_.end())
      texts_.push_back(std::move(text));
  }
  std::vector<std::string> take() { return std::move(texts_); }

 private:
  static constexpr std::size_t max_count = 50;
  std::vector<std::string> texts_;
};

}  // namespace heliograph::scene
