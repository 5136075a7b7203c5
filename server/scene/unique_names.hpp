#pragma once

#include <set>
#include <string>
#include <utility>

namespace heliograph::scene {

/// Names of parts of a scene, as clients use them: "sun", "sun 2" ...; "light 3" where there is no
/// name.
class UniqueNames {
 public:
  explicit UniqueNames(std::string kind) : kind_(std::move(kind)) {}

  std::string next(const std::string& requested) {
    const std::string number = std::to_string(++count_);
    std::string name = requested.empty() ? kind_ + " " + number : requested;
    for (int copy = 2; !taken_.insert(name).second; ++copy) {
      name = (requested.empty() ? kind_ : requested) + " " + std::to_string(copy);
    }
    return name;
  }

 private:
  const std::string kind_;
  int count_ = 0;
  std::set<std::string> taken_;
};

}  // namespace heliograph::scene
