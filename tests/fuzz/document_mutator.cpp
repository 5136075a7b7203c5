#include "document_mutator.hpp"

#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace heliograph::fuzz {
namespace {

using nlohmann::json;

struct Document {
  std::string text;
  std::vector<std::uint8_t> binary;
};

std::uint32_t read_u32(const std::uint8_t* bytes) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

std::optional<Document> split(const std::uint8_t* data, std::size_t size) {
  if (size < 20 || std::memcmp(data, "glTF", 4) != 0) return std::nullopt;
  const std::size_t text_size = read_u32(data + 12);
  if (text_size > size - 20) return std::nullopt;
  Document document{std::string(data + 20, data + 20 + text_size), {}};
  const std::size_t behind = 20 + text_size + 8;
  if (behind < size) document.binary.assign(data + behind, data + size);
  return document;
}

void append_u32(std::vector<std::uint8_t>& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(std::uint8_t(value >> shift));
}

std::vector<std::uint8_t> join(const Document& document) {
  std::string text = document.text;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<std::uint8_t> file = {'g', 'l', 'T', 'F', 2, 0, 0, 0};
  const std::size_t chunk = document.binary.empty() ? 0 : 8 + document.binary.size();
  append_u32(file, 20 + text.size() + chunk);
  append_u32(file, text.size());
  append_u32(file, 0x4e4f534a);
  file.insert(file.end(), text.begin(), text.end());
  if (chunk == 0) return file;
  append_u32(file, document.binary.size());
  append_u32(file, 0x004e4942);
  file.insert(file.end(), document.binary.begin(), document.binary.end());
  return file;
}

void collect(json& value, std::vector<json*>& found) {
  found.push_back(&value);
  if (!value.is_structured()) return;
  for (json& child : value) collect(child, found);
}

json odd_value(std::mt19937& random) {
  switch (random() % 12) {
    case 0:
      return random() % 8;
    case 1:
      return random() % 4096;
    case 2:
      return 0xffffffffull - random() % 2;
    case 3:
      return 0xffffffffffffffffull - random() % 65536;
    case 4:
      return -static_cast<int>(random() % 4);
    case 5:
      return 1e30 * (static_cast<double>(random() % 3) - 1.0);
    case 6:
      return 0.25 * (random() % 16);
    case 7:
      return nullptr;
    case 8:
      return json::array();
    case 9:
      return json::object();
    case 10:
      return true;
    default:
      return std::string(random() % 8, 'x');
  }
}

void mutate_member(json& root, std::mt19937& random) {
  std::vector<json*> all;
  collect(root, all);
  json& target = *all[random() % all.size()];
  switch (random() % 6) {
    case 0:
    case 1:
      target = odd_value(random);
      return;
    case 2:
      // A value from elsewhere in the document: sometimes of the right type, but for another
      // member.
      target = json(*all[random() % all.size()]);
      return;
    case 3:
      if (target.is_number_integer()) target = target.get<std::int64_t>() + 1 - 2 * (random() % 2);
      return;
    case 4:
      if (target.is_array()) {
        target.push_back(target.empty() ? odd_value(random)
                                        : json(target[random() % target.size()]));
      } else if (target.is_object() && !target.empty()) {
        target.erase(std::next(target.begin(), random() % target.size()));
      }
      return;
    default:
      if (target.is_array() && !target.empty()) target.erase(random() % target.size());
      return;
  }
}

template <typename Container>
void mutate_as_bytes(Container& bytes, std::size_t most, MutateBytes mutate_bytes) {
  const std::size_t size = bytes.size();
  bytes.resize(most);
  bytes.resize(mutate_bytes(reinterpret_cast<std::uint8_t*>(bytes.data()), size, most));
}

}  // namespace

std::size_t mutate_document(std::uint8_t* data, std::size_t size, std::size_t most,
                            std::mt19937& random, MutateBytes mutate_bytes) {
  auto document = split(data, size);
  if (!document || random() % 16 == 0) return mutate_bytes(data, size, most);
  const unsigned choice = random() % 8;
  json root = json::parse(document->text, nullptr, false);
  if (choice < 5 && !root.is_discarded()) {
    for (unsigned i = 0; i <= random() % 3; ++i) mutate_member(root, random);
    document->text = root.dump(-1, ' ', false, json::error_handler_t::replace);
  } else if (choice < 7 && !document->binary.empty()) {
    mutate_as_bytes(document->binary, document->binary.size() + 64, mutate_bytes);
  } else {
    mutate_as_bytes(document->text, document->text.size() + 64, mutate_bytes);
  }
  const std::vector<std::uint8_t> file = join(*document);
  if (file.size() > most) return mutate_bytes(data, size, most);
  std::memcpy(data, file.data(), file.size());
  return file.size();
}

}  // namespace heliograph::fuzz
