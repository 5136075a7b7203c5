#include "protocol/json/codec.hpp"

namespace heliograph::protocol {

#define METHOD(tag, ...) template struct MethodCodec<methods::tag>;
#define NOTIFICATION(tag, ...) template struct NotificationCodec<notifications::tag>;
#include "protocol/methods/section.def"
#undef METHOD
#undef NOTIFICATION

}  // namespace heliograph::protocol
