#include "protocol/methods.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "protocol/result.hpp"

namespace heliograph::protocol {
namespace {

using nlohmann::json;

std::string with_underscores(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '.', '_');
  return text;
}

TEST(Methods, TagsAndNamesAgreeAndAreUnique) {
  const std::vector<std::pair<std::string_view, std::string_view>> declared{
#define METHOD(tag, name, ...) {#tag, name},
#define NOTIFICATION(tag, name, ...) {#tag, name},
#include "protocol/methods/methods.def"
  };
  std::set<std::string_view> names;
  for (const auto& [tag, name] : declared) {
    EXPECT_EQ(tag, with_underscores(name));
    EXPECT_TRUE(names.insert(name).second) << name << " is declared twice";
  }
  EXPECT_EQ(declared.size(), method_table().size() + notification_table().size());
}

TEST(Methods, ExamplesMatchTheirSchemas) {
  for (const MethodDescriptor& method : method_table()) {
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

std::string readme() {
  std::ifstream file(std::filesystem::path(HELIOGRAPH_SOURCE_DIR) / "protocol/README.md");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The words of a table's cell that are set in backquotes, or separated by commas.
std::set<std::string> words_of(const std::string& cell) {
  std::set<std::string> words;
  std::string word;
  for (const char c : cell + ",") {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.') {
      word += c;
    } else if (!word.empty()) {
      words.insert(std::exchange(word, {}));
    }
  }
  return words;
}

/// The rows of the table of methods: name, names of the parameters.
std::map<std::string, std::set<std::string>> methods_of_readme() {
  std::map<std::string, std::set<std::string>> rows;
  std::istringstream lines(readme());
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    inside = line.starts_with("| `hello` |") || (inside && line.starts_with("|"));
    if (!inside) continue;
    const std::size_t first = line.find('|', 1);
    const std::size_t second = line.find('|', first + 1);
    const auto parameters = words_of(line.substr(first + 1, second - first - 1));
    for (const std::string& name : words_of(line.substr(1, first - 1))) rows[name] = parameters;
  }
  return rows;
}

TEST(Readme, ListsTheMethodsWithTheirParameters) {
  std::map<std::string, std::set<std::string>> declared;
  for (const MethodDescriptor& method : method_table()) {
    std::set<std::string>& parameters = declared[std::string(method.name)];
    const RawJson schema = method.params_schema();
    for (const auto& [name, member] : schema.value().at("properties").items()) {
      parameters.insert(name);
    }
  }
  EXPECT_EQ(methods_of_readme(), declared);
}

TEST(Readme, NamesEveryNotificationAndErrorCode) {
  const std::string page = readme();
  const auto names = [&](const std::string& text) {
    EXPECT_NE(page.find(text), std::string::npos) << text << " is missing";
  };
  for (const NotificationDescriptor& sent : notification_table()) names(std::string(sent.name));
  const RawJson document = openrpc_document();
  for (const json& error : document.value().at("components").at("errors")) {
    names(error.at("code").dump());
  }
}

TEST(OpenRpc, DescribesEveryMethodWithItsParameters) {
  const RawJson holder = openrpc_document();
  const json& document = holder.value();
  EXPECT_EQ(document.at("openrpc"), "1.3.2");
  EXPECT_EQ(document.at("methods").size(), method_table().size());
  EXPECT_EQ(document.at("x-notifications").size(), notification_table().size());
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

TEST(OpenRpc, ReferencedErrorsExist) {
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
  for (const MethodDescriptor& method : method_table()) {
    const auto also = [&](ErrorCode code) {
      return std::count(method.errors.begin(), method.errors.end(), code) == 1;
    };
    EXPECT_TRUE(!method.needs_control() || also(ErrorCode::forbidden)) << method.name;
    EXPECT_TRUE(method.read_only() || also(ErrorCode::forbidden)) << method.name;
  }
  EXPECT_EQ(codes, (std::set<int>{-32700, -32600, -32601, -32602, -32603, -32000, -32001, -32002,
                                  -32004, -32009, -32013, -32029, -32050}));
}

}  // namespace
}  // namespace heliograph::protocol
