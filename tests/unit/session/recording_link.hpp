#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "session/viewers/viewer_link.hpp"

namespace heliograph::session::test {

/// Records what it is sent.
class RecordingLink : public ViewerLink {
 public:
  void frame_ready() override { ++announced; }
  void send(std::string text, std::string_view key) override {
    messages.push_back(nlohmann::json::parse(text));
    keys.emplace_back(key);
  }
  void disconnect(std::string why) override { close_reason = std::move(why); }

  int announced = 0;
  std::string close_reason;
  std::vector<nlohmann::json> messages;
  std::vector<std::string> keys;
};

}  // namespace heliograph::session::test
