#include "net/websocket/rejected_calls.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace heliograph::net {
namespace {

using nlohmann::json;

/// The ids of the answer: a list for a batch, otherwise the one.
json ids(const std::string& message) {
  const auto error = protocol::error::make(protocol::ErrorCode::rate_limited, {}, "too many", "1");
  const json answer = json::parse(reject_calls(message, error));
  const auto id_of = [](const json& one) {
    EXPECT_EQ(one["jsonrpc"], "2.0");
    EXPECT_EQ(one["error"]["code"], -32002);
    EXPECT_EQ(one["error"]["data"], (json{{"path", ""}, {"reason", "too many"}, {"limit", "1"}}));
    return one["id"];
  };
  if (!answer.is_array()) return id_of(answer);
  json found = json::array();
  for (const json& one : answer) found.push_back(id_of(one));
  return found;
}

TEST(RejectedCalls, GetAnErrorWithTheirId) {
  EXPECT_EQ(ids(R"({"jsonrpc":"2.0","id":7,"method":"camera.get"})"), 7);
  EXPECT_EQ(ids(R"({"method":"x","params":{"id":1,"deep":[{"id":2}]},"id":"seven"})"), "seven");
  EXPECT_EQ(ids(R"({"id":-3})"), -3);
  EXPECT_EQ(ids(R"({"id":2.5})"), 2.5);
  EXPECT_EQ(ids(R"({"id":"\"quoted\" \u00fc"})"), "\"quoted\" \u00fc");
  EXPECT_EQ(ids(R"({"id":8} and then no JSON)"), 8);
}

TEST(RejectedCalls, GetANullIdIfNoneCanBeRead) {
  for (const char* text :
       {"", "{", R"({"method":"stream.ack","params":{"id":1})", "7", "[]", "[1]",
        R"({"id":{"id":1}})", R"({"id":[3]})", R"({"id":null})", R"([["id",1]])"}) {
    EXPECT_EQ(ids(text), nullptr) << text;
  }
}

TEST(RejectedCalls, NotificationsGetNoResponse) {
  for (const char* text : {R"({"method":"stream.ack","params":{"id":1}})", "{}",
                           R"([{"method":"x"},{"method":"y","params":{"id":2}}])"}) {
    EXPECT_EQ(reject_calls(text, too_many_messages()), "") << text;
  }
}

TEST(RejectedCalls, OfABatchGetAnErrorEach) {
  EXPECT_EQ(ids(R"([{"id":1,"params":{"id":9}},{"method":"x"},7,{"params":[{"id":8}],"id":"b"}])"),
            (json{1, "b"}));
  EXPECT_EQ(ids(R"([{"id":1}])"), json::array({1}));
}

TEST(RejectedCalls, MalformedTextIsCheap) {
  EXPECT_EQ(ids(std::string(65536, '[')), nullptr);
  EXPECT_EQ(ids(std::string(65536, '{')), nullptr);
  std::string batch = "[";
  for (int i = 0; i < 5000; ++i) batch += R"({"id":1},)";
  EXPECT_EQ(ids(batch).size(), 32u);
}

}  // namespace
}  // namespace heliograph::net
