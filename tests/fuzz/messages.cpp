// Arbitrary bytes as a JSON-RPC message must give one answer of valid JSON, or none; what the
// protocol accepts as parameters of a method, it must write and accept again. Patches of settings
// likewise.
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <string_view>

#include "protocol/json/codec.hpp"
#include "protocol/json/jsonrpc.hpp"
#include "protocol/settings/settings_json.hpp"

using namespace heliograph;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using nlohmann::json;

void require(bool holds) {
  if (!holds) std::abort();
}

/// What was read must survive being written and read. Members that JSON cannot hold as they are,
/// such as floats of more digits, have their final form after the first time.
template <class Message>
void check_round_trip(const Message& message) {
  const protocol::RawJson once = protocol::encode(message);
  const protocol::Result<Message> again = protocol::decode<Message>(once);
  require(again.has_value());
  require(protocol::encode(*again) == once);
}

template <class Method>
void serve(protocol::Dispatcher& dispatcher) {
  using Params = typename Method::Params;
  using Result = typename Method::Result;
  dispatcher.add<Method>([](const Params& params, const protocol::CallContext&,
                            const protocol::Completion<Result>& done) {
    check_round_trip(params);
    done(protocol::error::not_ready("nothing is done here"));
  });
}

protocol::Dispatcher all_methods() {
  protocol::Dispatcher dispatcher;
  for (const std::string_view name : dispatcher.missing_handlers()) {
#define METHOD(tag, method_name, ...) \
  if (name == method_name) serve<protocol::methods::tag>(dispatcher);
#include "protocol/methods/methods.def"
  }
  dispatcher.on_handler_failure([](std::string_view, std::string_view) { std::abort(); });
  return dispatcher;
}

void check_answer(const std::string& answer) {
  if (answer.empty()) return;
  const json parsed = json::parse(answer, nullptr, false);
  require(parsed.is_object() || parsed.is_array());
  for (const json& one : parsed.is_array() ? parsed : json::array({parsed})) {
    require(one.at("jsonrpc") == "2.0" && one.contains("id"));
    require(one.contains("result") != one.contains("error"));
  }
}

/// All or nothing, and what was applied may be applied again.
void check_patch(std::string_view text) {
  const auto patch = protocol::RawJson::parse(text);
  if (!patch) return;
  const protocol::Settings before;
  protocol::Settings settings;
  const auto applied = protocol::apply_patch(settings, patch->value());
  if (!applied) return require(protocol::to_json(settings) == protocol::to_json(before));
  protocol::Settings again;
  require(protocol::apply_patch(again, *applied).has_value());
  require(protocol::to_json(again) == protocol::to_json(settings));
}

/// A call of any method with the parameters of its example.
std::string example(std::mt19937& random) {
  const auto methods = protocol::method_table();
  const protocol::MethodDescriptor& method = methods[random() % methods.size()];
  return "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"" + std::string(method.name) +
         "\",\"params\":" + std::string(method.example_params) + "}";
}

/// A value that is at a limit of something, in place of a random one of the document.
bool replace_value(json& document, std::mt19937& random) {
  static const std::array<json, 14> values{
      nullptr, true,        0,  -1,     4294967296,    1e308,          -0.0,
      1e-320,  2147483648u, "", "main", json::array(), json::object(), std::string(5000, 'x')};
  if (document.is_structured() && !document.empty() && random() % 8 != 0) {
    auto chosen = document.begin();
    std::advance(chosen, static_cast<std::ptrdiff_t>(random() % document.size()));
    return replace_value(*chosen, random);
  }
  document = values[random() % values.size()];
  return true;
}

std::size_t put(const std::string& text, std::uint8_t* data, std::size_t most) {
  const std::size_t size = std::min(text.size(), most);
  std::copy_n(text.begin(), size, data);
  return size;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const protocol::Dispatcher dispatcher = all_methods();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  int replies = 0;
  dispatcher.handle(text, {}, [&](const std::string& answer) {
    ++replies;
    check_answer(answer);
  });
  require(replies == 1);
  if (size < 4096) check_patch(text);
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  std::mt19937 random(seed);
  const unsigned kind = random() % 16;
  if (kind == 0) return put(example(random), data, most);
  if (kind < 8) {
    json document =
        json::parse(std::string_view(reinterpret_cast<const char*>(data), size), nullptr, false);
    if (!document.is_discarded()) {
      replace_value(document, random);
      return put(document.dump(-1, ' ', false, json::error_handler_t::replace), data, most);
    }
  }
  return LLVMFuzzerMutate(data, size, most);
}
