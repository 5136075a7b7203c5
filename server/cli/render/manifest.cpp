#include "cli/render/manifest.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "protocol/json/codec.hpp"

namespace heliograph::cli {
namespace {

std::string text_of(const std::string& file) {
  const auto all = [](std::istream& in) {
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  if (file == "-") return all(std::cin);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("--manifest " + file + ": " + std::strerror(errno));
  return all(in);
}

nlohmann::json parsed(const std::string& text, const std::string& what) {
  auto value = protocol::RawJson::parse(text);
  if (!value) throw std::invalid_argument(what + ": is no JSON: " + value.error().message);
  return value->value();
}

nlohmann::json entries_of(const std::string& file) {
  const std::string text = text_of(file);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) throw std::invalid_argument(file + ": the manifest is empty");
  if (text[begin] == '[') return parsed(text, file);
  nlohmann::json entries = nlohmann::json::array();
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    entries.push_back(parsed(line, file + ": line " + std::to_string(number)));
  }
  return entries;
}

}  // namespace

std::vector<protocol::RenderRequest> read_manifest(const std::string& file,
                                                   const protocol::RenderRequest& common) {
  const nlohmann::json entries = entries_of(file);
  if (entries.empty()) throw std::invalid_argument(file + ": the manifest has no entries");
  const nlohmann::json shared = protocol::encode(common).value();
  std::vector<protocol::RenderRequest> requests;
  for (const nlohmann::json& entry : entries) {
    const std::string where = file + ": entry " + std::to_string(requests.size() + 1) + ": ";
    if (!entry.is_object()) throw std::invalid_argument(where + "must be an object");
    nlohmann::json whole = shared;
    for (const auto& [name, value] : entry.items()) whole[name] = value;
    auto request = protocol::decode<protocol::RenderRequest>(protocol::RawJson(std::move(whole)));
    if (!request) throw std::invalid_argument(where + request.error().message);
    requests.push_back(*std::move(request));
  }
  return requests;
}

}  // namespace heliograph::cli
