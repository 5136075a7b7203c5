#include "protocol/methods.hpp"

#include <initializer_list>

namespace heliograph::protocol {
namespace {

struct Example {
  std::string_view params;
  std::string_view result;
};

template <class Method>
MethodDescriptor describe(Call call, std::string_view summary, Example example,
                          std::initializer_list<ErrorCode> errors) {
  MethodDescriptor method{.name = Method::name,
                          .summary = summary,
                          .call = call,
                          .errors = errors,
                          .example_params = example.params,
                          .example_result = example.result,
                          .params_schema = MethodCodec<Method>::params_schema,
                          .result_schema = MethodCodec<Method>::result_schema,
                          .check_params = MethodCodec<Method>::check_params,
                          .check_result = MethodCodec<Method>::check_result};
  if (!method.read_only()) method.errors.push_back(ErrorCode::forbidden);
  return method;
}

}  // namespace

std::span<const MethodDescriptor> method_table() {
  static const std::vector<MethodDescriptor> table{
#define METHOD(tag, name, Params, Result, call, summary, params, result, ...) \
  describe<methods::tag>(Call::call, summary, {params, result}, {__VA_ARGS__}),
#include "protocol/methods/methods.def"
  };
  return table;
}

std::span<const NotificationDescriptor> notification_table() {
  static const std::vector<NotificationDescriptor> table{
#define NOTIFICATION(tag, name, Params, summary) \
  {name, summary, NotificationCodec<notifications::tag>::params_schema},
#include "protocol/methods/methods.def"
  };
  return table;
}

}  // namespace heliograph::protocol
