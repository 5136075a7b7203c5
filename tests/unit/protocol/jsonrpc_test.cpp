#include "protocol/json/jsonrpc.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

namespace heliograph::protocol {
namespace {

using nlohmann::json;

/// A dispatcher with a few handlers of the real protocol that record their calls.
class DispatcherTest : public testing::Test {
 protected:
  DispatcherTest() {
    dispatcher.add<methods::camera_set>(
        [this](CameraSet request, const CallContext& context, auto done) {
          viewers.push_back(context.viewer);
          Camera camera;
          camera.eye = request.eye.value_or(camera.eye);
          done(camera);
        });
    dispatcher.add<methods::scene_load>(
        [this](SceneLoad, const CallContext&, Completion<SceneInfo> done) {
          loads.push_back(std::move(done));
        });
    dispatcher.add<methods::camera_get>(
        [](Empty, const CallContext&, auto) { throw std::runtime_error("secret detail"); });
    dispatcher.add<methods::camera_fit>([](const CameraFit&, const CallContext&, auto done) {
      done(error::not_ready("no scene is loaded"));
    });
    dispatcher.add<methods::frame_buffers>([this](Empty, const CallContext&, auto done) {
      ++buffer_calls;
      done(FrameBuffers{});
    });
  }

  /// The response text; fails unless it arrives synchronously and once.
  std::string text_of(std::string_view message) {
    std::vector<std::string> replies;
    dispatcher.handle(message, CallContext{"v1"},
                      [&](std::string text) { replies.push_back(std::move(text)); });
    EXPECT_EQ(replies.size(), 1u) << message;
    return replies.empty() ? std::string() : replies.front();
  }

  json reply_to(std::string_view message) { return json::parse(text_of(message)); }

  static int code_of(const json& answer) { return answer.at("error").at("code"); }

  Dispatcher dispatcher;
  std::vector<std::string> viewers;
  std::vector<Completion<SceneInfo>> loads;
  int buffer_calls = 0;
};

TEST_F(DispatcherTest, AnswersARequestWithItsResultAndId) {
  const json answer =
      reply_to(R"({"jsonrpc":"2.0","id":7,"method":"camera.set","params":{"eye":[1,2,3]}})");
  EXPECT_EQ(answer.at("jsonrpc"), "2.0");
  EXPECT_EQ(answer.at("id"), 7);
  EXPECT_EQ(answer.at("result").at("eye"), json::parse("[1.0,2.0,3.0]"));
  EXPECT_FALSE(answer.contains("error"));
  EXPECT_EQ(viewers, std::vector<std::string>{"v1"});
}

TEST_F(DispatcherTest, EchoesEveryKindOfId) {
  for (const char* id : {"\"a\"", "\"\"", "0", "-5", "1.5", "12345678901234567890", "null"}) {
    const json answer =
        reply_to(std::string(R"({"jsonrpc":"2.0","method":"camera.set","id":)") + id + "}");
    EXPECT_EQ(answer.at("id").dump(), id);
    EXPECT_TRUE(answer.contains("result"));
  }
}

TEST_F(DispatcherTest, RefusesOtherIds) {
  for (const char* id : {"{}", "[1]", "true"}) {
    const json answer =
        reply_to(std::string(R"({"jsonrpc":"2.0","method":"camera.set","id":)") + id + "}");
    EXPECT_EQ(code_of(answer), -32600);
    EXPECT_TRUE(answer.at("id").is_null());
  }
  EXPECT_TRUE(viewers.empty());
}

TEST_F(DispatcherTest, ExecutesNotificationsWithoutResponse) {
  EXPECT_EQ(text_of(R"({"jsonrpc":"2.0","method":"camera.set","params":{"eye":[1,2,3]}})"), "");
  EXPECT_EQ(viewers.size(), 1u);
  // Neither errors nor unknown methods are answered.
  EXPECT_EQ(text_of(R"({"jsonrpc":"2.0","method":"camera.set","params":{"eye":1}})"), "");
  EXPECT_EQ(text_of(R"({"jsonrpc":"2.0","method":"no.such"})"), "");
  EXPECT_EQ(viewers.size(), 1u);
}

TEST_F(DispatcherTest, DropsQueriesWithoutId) {
  EXPECT_EQ(text_of(R"({"jsonrpc":"2.0","method":"frame.buffers"})"), "");
  EXPECT_EQ(buffer_calls, 0);
  reply_to(R"({"jsonrpc":"2.0","id":1,"method":"frame.buffers"})");
  EXPECT_EQ(buffer_calls, 1);
}

TEST_F(DispatcherTest, RefusesInvalidJson) {
  for (const char* text : {"", " ", "{", "nonsense", "{\"a\":1,}", "[1", "\"\xff\"", "1 2",
                           "{\"jsonrpc\":\"2.0\",\"id\":1e999}", "// comment\n{}"}) {
    const json answer = reply_to(text);
    EXPECT_EQ(code_of(answer), -32700) << text;
    EXPECT_TRUE(answer.at("id").is_null());
  }
}

TEST_F(DispatcherTest, RefusesInvalidRequests) {
  for (const char* text :
       {"1", "null", "\"x\"", "{}", R"({"jsonrpc":"1.0","method":"camera.set"})",
        R"({"jsonrpc":2.0,"method":"camera.set"})", R"({"jsonrpc":"2.0"})",
        R"({"jsonrpc":"2.0","method":1})", R"({"jsonrpc":"2.0","method":"camera.set","params":1})",
        R"({"jsonrpc":"2.0","method":"camera.set","params":null})"}) {
    EXPECT_EQ(code_of(reply_to(text)), -32600) << text;
  }
  EXPECT_EQ(reply_to(R"({"jsonrpc":"1.0","id":3,"method":"camera.set"})").at("id"), 3);
}

TEST_F(DispatcherTest, SuggestsTheNearestMethod) {
  const json answer = reply_to(R"({"jsonrpc":"2.0","id":1,"method":"camera.sett"})");
  EXPECT_EQ(code_of(answer), -32601);
  EXPECT_EQ(answer.at("error").at("data").at("path"), "method");
  EXPECT_NE(answer.at("error").at("data").at("reason").get<std::string>().find(
                "did you mean camera.set?"),
            std::string::npos);
  const json far = reply_to(R"({"jsonrpc":"2.0","id":1,"method":"launch.missiles"})");
  EXPECT_EQ(far.at("error").at("data").at("reason"), "unknown method");
}

TEST_F(DispatcherTest, NamesTheInvalidParameterAndItsLimit) {
  const json answer =
      reply_to(R"({"jsonrpc":"2.0","id":1,"method":"camera.set","params":{"vertical_fov":500}})");
  EXPECT_EQ(code_of(answer), -32602);
  EXPECT_EQ(answer.at("error").at("data"),
            json::parse(R"({"path":"vertical_fov","reason":"is out of range",
                            "limit":"1 to 170"})"));
  EXPECT_TRUE(viewers.empty());
}

TEST_F(DispatcherTest, AcceptsParametersByNameOnly) {
  EXPECT_EQ(
      code_of(reply_to(R"({"jsonrpc":"2.0","id":1,"method":"camera.set","params":[[1,2,3]]})")),
      -32602);
  EXPECT_TRUE(
      reply_to(R"({"jsonrpc":"2.0","id":1,"method":"camera.set","params":[]})").contains("result"));
}

TEST_F(DispatcherTest, ReturnsTheErrorOfAHandler) {
  const json answer = reply_to(R"({"jsonrpc":"2.0","id":1,"method":"camera.fit"})");
  EXPECT_EQ(code_of(answer), -32050);
  EXPECT_EQ(answer.at("error").at("message"), "no scene is loaded");
}

TEST_F(DispatcherTest, HidesExceptionsFromClientsButReportsThem) {
  std::string reported;
  dispatcher.on_handler_failure([&](std::string_view method, std::string_view what) {
    reported = std::string(method) + ": " + std::string(what);
  });
  const std::string text = text_of(R"({"jsonrpc":"2.0","id":1,"method":"camera.get"})");
  EXPECT_EQ(code_of(json::parse(text)), -32603);
  EXPECT_EQ(text.find("secret"), std::string::npos);
  EXPECT_EQ(reported, "camera.get: secret detail");
}

TEST_F(DispatcherTest, AnswersLaterAndFromAnotherThread) {
  std::promise<std::string> replied;
  dispatcher.handle(R"({"jsonrpc":"2.0","id":1,"method":"scene.load","params":{"name":"a"}})",
                    CallContext{}, [&](std::string text) { replied.set_value(std::move(text)); });
  ASSERT_EQ(loads.size(), 1u);
  std::thread worker([done = std::move(loads.front())] {
    SceneInfo info;
    info.name = "a";
    done(info);
    done(info);  // only the first result is used
  });
  worker.join();
  EXPECT_EQ(json::parse(replied.get_future().get()).at("result").at("name"), "a");
}

TEST_F(DispatcherTest, AnswersForAHandlerThatDropsItsCompletion) {
  std::vector<std::string> replies;
  dispatcher.handle(R"({"jsonrpc":"2.0","id":1,"method":"scene.load","params":{"name":"a"}})",
                    CallContext{}, [&](std::string text) { replies.push_back(text); });
  EXPECT_TRUE(replies.empty());
  loads.clear();
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_EQ(code_of(json::parse(replies.front())), -32050);
}

TEST_F(DispatcherTest, AnswersABatchOnceAllIsDone) {
  std::vector<std::string> replies;
  dispatcher.handle(R"([
      {"jsonrpc":"2.0","id":1,"method":"scene.load","params":{"name":"a"}},
      {"jsonrpc":"2.0","method":"camera.set","params":{}},
      {"jsonrpc":"2.0","id":2,"method":"camera.set","params":{}},
      {"jsonrpc":"2.0","id":3,"method":"scene.load","params":{"name":"b"}},
      7,
      {"jsonrpc":"2.0","id":4,"method":"no.such"}])",
                    CallContext{}, [&](std::string text) { replies.push_back(text); });
  ASSERT_EQ(loads.size(), 2u);
  loads[1](SceneInfo{});
  EXPECT_TRUE(replies.empty()) << "one scene is still loading";
  loads[0](SceneInfo{});
  ASSERT_EQ(replies.size(), 1u);
  const json answers = json::parse(replies.front());
  ASSERT_EQ(answers.size(), 5u) << "every request, not the notification";
  EXPECT_EQ(answers[0].at("id"), 1);
  EXPECT_EQ(answers[1].at("id"), 2);
  EXPECT_EQ(answers[2].at("id"), 3);
  EXPECT_EQ(code_of(answers[3]), -32600);
  EXPECT_EQ(code_of(answers[4]), -32601);
}

TEST_F(DispatcherTest, CompletesABatchFromManyThreads) {
  for (int round = 0; round < 50; ++round) {
    json batch = json::array();
    for (int i = 0; i < 16; ++i) {
      batch.push_back(
          {{"jsonrpc", "2.0"}, {"id", i}, {"method", "scene.load"}, {"params", {{"name", "a"}}}});
    }
    std::promise<std::string> replied;
    dispatcher.handle(batch.dump(), CallContext{},
                      [&](std::string text) { replied.set_value(std::move(text)); });
    std::vector<std::thread> workers;
    for (Completion<SceneInfo>& load : loads) {
      workers.emplace_back([done = std::move(load)] { done(SceneInfo{}); });
    }
    loads.clear();
    for (std::thread& worker : workers) worker.join();
    EXPECT_EQ(json::parse(replied.get_future().get()).size(), 16u);
  }
}

TEST_F(DispatcherTest, AnswersNothingToABatchOfNotifications) {
  EXPECT_EQ(text_of(R"([{"jsonrpc":"2.0","method":"camera.set"},
                        {"jsonrpc":"2.0","method":"camera.set"}])"),
            "");
  EXPECT_EQ(viewers.size(), 2u);
}

TEST_F(DispatcherTest, RefusesEmptyAndOversizedBatches) {
  const json empty = reply_to("[]");
  EXPECT_TRUE(empty.is_object());
  EXPECT_EQ(code_of(empty), -32600);

  json batch = json::array();
  for (int i = 0; i < 32; ++i) {
    batch.push_back({{"jsonrpc", "2.0"}, {"id", i}, {"method", "camera.set"}});
  }
  EXPECT_EQ(reply_to(batch.dump()).size(), 32u);
  batch.push_back(batch.front());
  const json refused = reply_to(batch.dump());
  EXPECT_TRUE(refused.is_object());
  EXPECT_EQ(code_of(refused), -32013);
  EXPECT_EQ(refused.at("error").at("data").at("limit"), "32");
  EXPECT_EQ(viewers.size(), 32u) << "nothing of a refused batch is carried out";
}

std::string nested(std::size_t levels) {
  return std::string(levels, '[') + std::string(levels, ']');
}

TEST_F(DispatcherTest, RefusesDeepJson) {
  const auto request = [](const std::string& value) {
    return R"({"jsonrpc":"2.0","id":1,"method":"camera.set","params":{"x":)" + value + "}}";
  };
  EXPECT_TRUE(reply_to(request(nested(62))).contains("result"));
  EXPECT_EQ(code_of(reply_to(request(nested(63)))), -32013);
  EXPECT_EQ(code_of(reply_to(std::string(60000, '['))), -32013);
  EXPECT_EQ(code_of(reply_to(std::string(60000, '{'))), -32013);
}

TEST_F(DispatcherTest, BracketsInStringsAreNotDepth) {
  const std::string brackets(200, '[');
  EXPECT_TRUE(reply_to(R"({"jsonrpc":"2.0","id":1,"method":"camera.set","params":{"x":"\"\\)" +
                       brackets + "\"}}")
                  .contains("result"));
}

TEST_F(DispatcherTest, RefusesLongMessages) {
  const std::string text = R"({"jsonrpc":"2.0","id":1,"method":"camera.set"})";
  EXPECT_TRUE(reply_to(text + std::string(64 * 1024 - text.size(), ' ')).contains("result"));
  const json answer = reply_to(text + std::string(64 * 1024 - text.size() + 1, ' '));
  EXPECT_EQ(code_of(answer), -32013);
  EXPECT_EQ(answer.at("error").at("data").at("limit"), "65536 bytes");
}

TEST_F(DispatcherTest, DescribesItself) {
  EXPECT_EQ(reply_to(R"({"jsonrpc":"2.0","id":1,"method":"rpc.discover"})").at("result"),
            openrpc_document().value());
  const json schema = reply_to(R"({"jsonrpc":"2.0","id":1,"method":"settings.schema"})");
  EXPECT_TRUE(schema.at("result").at("properties").contains("tone_map"));
}

TEST_F(DispatcherTest, RefusesSecondHandlersAndMethodsItDoesNotServe) {
  const auto nothing = [](auto&&...) {};
  EXPECT_THROW((dispatcher.add<methods::camera_set>(nothing)), std::logic_error) << "added twice";
  Dispatcher of_no_method({}, {});
  EXPECT_THROW((of_no_method.add<methods::camera_set>(nothing)), std::logic_error);
}

TEST_F(DispatcherTest, ListsMethodsWithoutHandler) {
  const auto missing = dispatcher.missing_handlers();
  EXPECT_NE(std::find(missing.begin(), missing.end(), "hello"), missing.end());
  EXPECT_EQ(std::find(missing.begin(), missing.end(), "camera.set"), missing.end());
  EXPECT_EQ(code_of(reply_to(R"({"jsonrpc":"2.0","id":1,"method":"hello"})")), -32601);
}

TEST_F(DispatcherTest, SurvivesArbitraryDamage) {
  const std::string whole =
      R"([{"jsonrpc":"2.0","id":"x","method":"camera.set","params":{"eye":[1,2.5,-3e2]}}])";
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char byte : {'\0', '"', '[', '}', '\\', '\xff', '9'}) {
      std::string damaged = whole;
      damaged[at] = byte;
      const std::string text = text_of(damaged);
      EXPECT_TRUE(text.empty() || json::accept(text)) << damaged;
    }
    text_of(whole.substr(0, at));
  }
}

TEST(Notification, IsARequestWithoutId) {
  StatsFrame stats;
  stats.passes.push_back({"gbuffer", PassKind::device, 1.5});
  const json text = json::parse(make_notification<notifications::stats_frame>(stats));
  EXPECT_EQ(text.at("jsonrpc"), "2.0");
  EXPECT_EQ(text.at("method"), "stats.frame");
  EXPECT_FALSE(text.contains("id"));
  EXPECT_EQ(text.at("params").at("passes")[0].dump(),
            R"({"kind":"device","ms":1.5,"name":"gbuffer"})");
}

}  // namespace
}  // namespace heliograph::protocol
