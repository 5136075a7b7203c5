#include "protocol/methods.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "protocol/result.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

TEST(Methods, AreThoseOfTheContract) {
  std::set<std::string_view> names;
  for (const MethodDescriptor& method : methods()) names.insert(method.name);
  EXPECT_EQ(names.size(), methods().size());
  EXPECT_EQ(names, (std::set<std::string_view>{"hello",
                                               "session.create",
                                               "session.join",
                                               "session.list",
                                               "session.info",
                                               "session.control",
                                               "session.close",
                                               "scene.list",
                                               "scene.load",
                                               "scene.cancel",
                                               "scene.info",
                                               "camera.get",
                                               "camera.set",
                                               "camera.fit",
                                               "animation.list",
                                               "animation.play",
                                               "animation.pause",
                                               "animation.seek",
                                               "animation.rate",
                                               "settings.get",
                                               "settings.patch",
                                               "settings.presets",
                                               "settings.preset",
                                               "settings.schema",
                                               "stream.configure",
                                               "stream.pause",
                                               "stream.resume",
                                               "stream.ack",
                                               "stats.subscribe",
                                               "frame.buffers",
                                               "frame.capture",
                                               "rpc.discover",
                                               "scene.unload",
                                               "scene.pick",
                                               "camera.orbit",
                                               "lights.list",
                                               "lights.patch",
                                               "materials.list",
                                               "materials.patch",
                                               "environment.list",
                                               "environment.set",
                                               "frame.inspect",
                                               "frame.step",
                                               "frame.run",
                                               "reference.start",
                                               "reference.stop",
                                               "reference.status"}));
}

TEST(Methods, ExamplesAreWhatTheMethodsTakeAndGive) {
  for (const MethodDescriptor& method : methods()) {
    const Result<RawJson> params = RawJson::parse(method.example_params);
    ASSERT_TRUE(params) << method.name;
    const Result<void> params_fit = method.check_params(*params);
    EXPECT_TRUE(params_fit) << method.name << ": " << params_fit.error().message;

    const Result<RawJson> result = RawJson::parse(method.example_result);
    ASSERT_TRUE(result) << method.name;
    const Result<void> result_fits = method.check_result(*result);
    EXPECT_TRUE(result_fits) << method.name << ": " << result_fits.error().message;
  }
}

TEST(Readme, NamesEveryMethodNotificationAndErrorCode) {
  const auto folder = std::filesystem::path(__FILE__).parent_path();
  std::ifstream file(folder / "../../../protocol/README.md");
  ASSERT_TRUE(file);
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const auto names = [&](const std::string& text) {
    EXPECT_NE(page.find(text), std::string::npos) << text << " is missing";
  };
  for (const MethodDescriptor& method : methods()) names("`" + std::string(method.name) + "`");
  for (const NotificationDescriptor& sent : notifications()) names(std::string(sent.name));
  const RawJson document = openrpc_document();
  for (const json& error : document.value().at("components").at("errors")) {
    names(error.at("code").dump());
  }
}

TEST(OpenRpc, DescribesEveryMethodWithItsParameters) {
  const RawJson holder = openrpc_document();
  const json& document = holder.value();
  EXPECT_EQ(document.at("openrpc"), "1.3.2");
  EXPECT_EQ(document.at("methods").size(), methods().size());
  EXPECT_EQ(document.at("x-notifications").size(), notifications().size());
  for (const json& method : document.at("methods")) {
    bool optional_seen = false;
    for (const json& param : method.at("params")) {
      EXPECT_TRUE(param.at("schema").contains("type")) << method.at("name");
      const bool required = param.at("required");
      EXPECT_FALSE(required && optional_seen) << method.at("name") << ": required comes first";
      optional_seen |= !required;
    }
    EXPECT_TRUE(method.at("result").contains("schema"));
    EXPECT_EQ(method.at("examples").size(), 1u);
  }
}

TEST(OpenRpc, EveryErrorThatIsReferredToExists) {
  const RawJson holder = openrpc_document();
  const json& document = holder.value();
  std::set<int> codes;
  for (const json& method : document.at("methods")) {
    for (const json& error : method.at("errors")) {
      const std::string reference = error.at("$ref");
      ASSERT_TRUE(reference.starts_with("#"));
      EXPECT_TRUE(document.contains(json::json_pointer(reference.substr(1)))) << reference;
    }
  }
  for (const json& error : document.at("components").at("errors")) {
    codes.insert(error.at("code").get<int>());
  }
  for (const MethodDescriptor& method : methods()) {
    const auto also = [&](ErrorCode code) {
      return std::count(method.errors.begin(), method.errors.end(), code) == 1;
    };
    EXPECT_TRUE(!method.needs_control || also(ErrorCode::forbidden)) << method.name;
    EXPECT_TRUE(method.read_only || also(ErrorCode::forbidden)) << method.name;
  }
  EXPECT_EQ(codes, (std::set<int>{-32700, -32600, -32601, -32602, -32603, -32000, -32001, -32002,
                                  -32004, -32009, -32013, -32029, -32050}));
}

}  // namespace
}  // namespace heliograph::protocol
