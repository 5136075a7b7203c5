#include "protocol/messages/messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/json/codec.hpp"
#include "protocol/json/json_values.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

HELIOGRAPH_ENUM(Colour, red, green, default_)

struct Inner {
  Vec3 position{};
  std::optional<int> count;

  static constexpr auto fields() {
    return std::tuple{field("position", &Inner::position, "Where.").range(-10, 10),
                      field("count", &Inner::count, "How many.").range(0, 5)};
  }
  bool operator==(const Inner&) const = default;
};

/// One member of every kind that a message may have.
struct Everything {
  bool flag = false;
  std::int32_t small = 0;
  std::uint32_t whole = 0;
  std::uint64_t large = 0;
  float single = 0.0f;
  double number = 0.0;
  std::string text;
  Colour colour = Colour::red;
  std::vector<Inner> list;
  std::vector<std::string> names{"first"};
  std::optional<std::string> maybe;
  RawJson tree;

  static constexpr auto fields() {
    return std::tuple{
        field("flag", &Everything::flag, "A flag."),
        field("small", &Everything::small, "An integer."),
        field("whole", &Everything::whole, "An integer from 0."),
        field("large", &Everything::large, "A large number.").unit("bytes"),
        field("single", &Everything::single, "A number."),
        field("number", &Everything::number, "A number.").range(0, 1),
        field("text", &Everything::text, "A text.").length(2, 4),
        field("colour", &Everything::colour, "A choice."),
        field("list", &Everything::list, "Things.").length(1, 3),
        field("names", &Everything::names, "Names.").or_default(),
        field("maybe", &Everything::maybe, "Perhaps a text.").or_null(),
        field("tree", &Everything::tree, "Anything."),
    };
  }
  bool operator==(const Everything&) const = default;
};

json message_example() {
  return json::parse(R"({
    "flag": true, "small": -7, "whole": 4294967295, "large": 9007199254740991, "single": 0.1,
    "number": 0.25, "text": "abc", "colour": "default",
    "list": [{"position": [1, 2, 3]}, {"position": [-1, 0, 0.5], "count": 5}],
    "names": ["x", "y"], "maybe": null, "tree": {"deep": [1, null]}})");
}

TEST(Messages, EveryKindOfMemberSurvivesTheRoundTrip) {
  const Result<Everything> read = decode<Everything>(RawJson(message_example()));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->flag);
  EXPECT_EQ(read->whole, 4294967295u);
  EXPECT_EQ(read->large, 9007199254740991u);
  EXPECT_EQ(read->colour, Colour::default_);
  EXPECT_EQ(read->list[1].count, 5);
  EXPECT_EQ(read->list[0].position, (Vec3{1, 2, 3}));
  EXPECT_EQ(read->maybe, std::nullopt);
  EXPECT_EQ(encode(*read).value(), message_example());
}

TEST(Messages, UnknownMembersAreIgnored) {
  json with_more = message_example();
  with_more["future"] = {{"any", "thing"}};
  with_more["list"][0]["future"] = 1;
  const Result<Everything> read = decode<Everything>(RawJson(with_more));
  ASSERT_TRUE(read);
  EXPECT_EQ(encode(*read).value(), message_example());
}

TEST(Messages, AbsentOrNullMembersKeepTheirDefault) {
  json without = message_example();
  without.erase("names");
  EXPECT_EQ(decode<Everything>(RawJson(without))->names, std::vector<std::string>{"first"});
  without["names"] = nullptr;
  EXPECT_EQ(decode<Everything>(RawJson(without))->names, std::vector<std::string>{"first"});
}

TEST(Messages, EmptyOptionalsAreOmittedUnlessNullable) {
  EXPECT_EQ(encode(Inner{}).value(), json::parse(R"({"position":[0.0,0.0,0.0]})"));
  EXPECT_TRUE(encode(Everything{}).value().at("maybe").is_null());
}

struct BadMember {
  const char* pointer;
  const char* value;
  const char* path;
  const char* reason_part;
  const char* limit;
};

void PrintTo(const BadMember& bad, std::ostream* out) {
  *out << bad.pointer << "=" << bad.value;
}

class MessageRefuses : public testing::TestWithParam<BadMember> {};

TEST_P(MessageRefuses, NamesPathReasonAndLimit) {
  json message = message_example();
  message[json::json_pointer(GetParam().pointer)] = json::parse(GetParam().value);
  const Result<Everything> read = decode<Everything>(RawJson(message));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::invalid_params);
  EXPECT_EQ(read.error().path, GetParam().path);
  EXPECT_NE(read.error().reason.find(GetParam().reason_part), std::string::npos)
      << read.error().reason;
  EXPECT_EQ(read.error().limit, GetParam().limit);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, MessageRefuses,
    testing::Values(
        BadMember{"/flag", "0", "flag", "true or false", ""},
        BadMember{"/flag", "null", "flag", "is required", ""},
        BadMember{"/small", "2147483648", "small", "out of range", "-2147483648 to 2147483647"},
        BadMember{"/small", "1.5", "small", "integer", "-2147483648 to 2147483647"},
        BadMember{"/small", "\"1\"", "small", "integer", "-2147483648 to 2147483647"},
        BadMember{"/whole", "-1", "whole", "out of range", "0 to 4294967295"},
        BadMember{"/whole", "4294967296", "whole", "out of range", "0 to 4294967295"},
        BadMember{"/large", "-1", "large", "out of range", "0 to 9007199254740991"},
        BadMember{"/large", "18446744073709551615", "large", "out of range",
                  "0 to 9007199254740991"},
        BadMember{"/single", "1e39", "single", "out of range", ""},
        BadMember{"/single", "[]", "single", "must be a number", ""},
        BadMember{"/number", "1.01", "number", "out of range", "0 to 1"},
        BadMember{"/text", "\"a\"", "text", "number of characters", "2 to 4"},
        BadMember{"/text", "\"abcde\"", "text", "number of characters", "2 to 4"},
        BadMember{"/text", "7", "text", "must be a string", ""},
        BadMember{"/colour", "\"gren\"", "colour", "did you mean green?", "red, green or default"},
        BadMember{"/colour", "1", "colour", "must be a string", "red, green or default"},
        BadMember{"/list", "{}", "list", "must be a list", ""},
        BadMember{"/list", "[]", "list", "number of elements", "1 to 3"},
        BadMember{"/list", "[1]", "list[0]", "must be an object", ""},
        BadMember{"/list/1/position", "[1,2]", "list[1].position", "list of 3 elements", ""},
        BadMember{"/list/1/position", "[1,2,3,4]", "list[1].position", "list of 3 elements", ""},
        BadMember{"/list/1/position", "[1,2,11]", "list[1].position[2]", "out of range",
                  "-10 to 10"},
        BadMember{"/list/1/position", "[1,null,3]", "list[1].position[1]", "must be a number",
                  "-10 to 10"},
        BadMember{"/list/0/count", "6", "list[0].count", "out of range", "0 to 5"},
        BadMember{"/names", "[\"a\", 1]", "names[1]", "must be a string", ""}));

TEST(MessageRefuses, AMissingMember) {
  json message = message_example();
  message.erase("tree");
  const Result<Everything> read = decode<Everything>(RawJson(message));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().path, "tree");
  EXPECT_EQ(read.error().reason, "is required");
}

TEST(MessageRefuses, ValuesOtherThanObjects) {
  for (const char* text : {"[]", "1", "null", "\"x\""}) {
    const Result<Everything> read = decode<Everything>(*RawJson::parse(text));
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().path, "params");
  }
}

TEST(MessageRefuses, NumbersThatAreNotFinite) {
  json message = message_example();
  message["number"] = std::nan("");
  const Result<Everything> read = decode<Everything>(RawJson(message));
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().reason.find("finite"), std::string::npos);
}

TEST(MessageSchema, HasTheLimitsOfParsing) {
  const RawJson schema_holder = schema_of<Everything>();
  const json& schema = schema_holder.value();
  const json& members = schema.at("properties");
  EXPECT_EQ(schema["type"], "object");
  EXPECT_EQ(members["whole"]["minimum"], 0);
  EXPECT_EQ(members["whole"]["maximum"], 4294967295u);
  EXPECT_EQ(members["large"]["x-unit"], "bytes");
  EXPECT_FALSE(members["single"].contains("minimum"));
  EXPECT_EQ(members["number"]["maximum"], 1.0);
  EXPECT_EQ(members["text"]["minLength"], 2);
  EXPECT_EQ(members["colour"]["enum"], json::parse(R"(["red","green","default"])"));
  EXPECT_EQ(members["list"]["maxItems"], 3);
  EXPECT_EQ(members["list"]["items"]["required"], json::parse(R"(["position"])"));
  EXPECT_EQ(members["list"]["items"]["properties"]["position"]["minItems"], 3);
  EXPECT_EQ(members["list"]["items"]["properties"]["position"]["items"]["maximum"], 10.0);
  EXPECT_EQ(members["names"]["default"], json::parse(R"(["first"])"));
  EXPECT_EQ(members["maybe"]["type"], json::parse(R"(["string","null"])"));
  const json& required = schema["required"];
  const auto is_required = [&](const char* name) {
    return std::find(required.begin(), required.end(), name) != required.end();
  };
  EXPECT_TRUE(is_required("flag") && is_required("maybe") && is_required("tree"));
  EXPECT_FALSE(is_required("names"));
}

TEST(Patch, DistinguishesAbsentNullAndValue) {
  const auto patch = decode<LightsPatch>(
      RawJson(json{{"light", "sun"}, {"patch", {{"intensity", 2}, {"color", nullptr}}}}));
  ASSERT_TRUE(patch);
  EXPECT_EQ(patch->patch.intensity, (Change<float>{.value = 2.0f}));
  EXPECT_EQ(patch->patch.color, (Change<Vec3>{.reset = true}));
  EXPECT_EQ(patch->patch.radius, Change<float>());
  EXPECT_EQ(encode(*patch).value(),
            (json{{"light", "sun"}, {"patch", {{"intensity", 2.0}, {"color", nullptr}}}}));
}

TEST(Patch, RefusesUnknownMembersAndNamesTheNearest) {
  const auto refused =
      decode<LightsPatch>(RawJson(json{{"light", "sun"}, {"patch", {{"intesity", 2}}}}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().path, "patch.intesity");
  EXPECT_NE(refused.error().reason.find("intensity"), std::string::npos);
}

TEST(Patch, SchemaForbidsUnknownMembers) {
  const RawJson holder = schema_of<LightsPatch>();
  const json& patch = holder.value().at("properties").at("patch");
  EXPECT_EQ(patch.at("additionalProperties"), false);
  EXPECT_EQ(patch.at("properties").at("intensity").at("type"), (json{"number", "null"}));
  EXPECT_FALSE(patch.contains("required"));
}

TEST(CameraSet, AcceptsPartsAndRefusesInvalidCameras) {
  const auto read = [](const char* text) { return decode<CameraSet>(*RawJson::parse(text)); };
  EXPECT_TRUE(read("{}"));
  EXPECT_EQ(read(R"({"eye":[1,2,3],"seq":9})")->eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(read(R"({"eye":[1,2,3],"seq":9})")->seq, 9u);
  EXPECT_EQ(read(R"({"vertical_fov":0})").error().limit, "1 to 170");
  EXPECT_EQ(read(R"({"eye":[1,2]})").error().path, "eye");
  EXPECT_EQ(read(R"({"eye":[1e300,0,0]})").error().path, "eye[0]");
  EXPECT_EQ(read(R"({"seq":-1})").error().path, "seq");
}

TEST(Limits, AreWrittenInShortestForm) {
  EXPECT_EQ(range_text({0, 100000}), "0 to 100000");
  EXPECT_EQ(range_text({-1e9, 1e9}), "-1e9 to 1e9");
  EXPECT_EQ(range_text({1e-6, 0.25}), "1e-6 to 0.25");
  EXPECT_EQ(number_text(-1.5e10), "-1.5e10");
  EXPECT_EQ(number_text(1e100), "1e100");
  EXPECT_EQ(number_text(1e-10), "1e-10");
}

TEST(HelloResult, WritesTheNamesOfTheProtocol) {
  HelloResult result;
  result.device.type = DeviceType::virtual_;
  result.tracer = TracerKind::embree;
  const RawJson written = encode(result);
  EXPECT_EQ(written.value().at("protocol"), "heliograph.v1");
  EXPECT_EQ(written.value().at("device").at("type"), "virtual");
  EXPECT_EQ(written.value().at("tracer"), "embree");
  const Result<HelloResult> read = decode<HelloResult>(written);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, result);
}

TEST(RawJson, WritesBytesThatAreNotUtf8AsReplacements) {
  SceneInfo scene;
  scene.name = "caf\xe9";
  EXPECT_NE(encode(scene).text().find("caf\xef\xbf\xbd"), std::string::npos);
}

}  // namespace
}  // namespace heliograph::protocol
