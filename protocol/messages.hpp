#pragma once

// Parameters and results of every method, and the notifications the server sends. What is declared
// in these files is all there is: parsing, validation, writing and the OpenRPC document come from
// each message's `fields()`.

#include "protocol/frame_messages.hpp"
#include "protocol/loading_messages.hpp"
#include "protocol/membership_messages.hpp"
#include "protocol/scene_messages.hpp"
#include "protocol/session_messages.hpp"
#include "protocol/stream_messages.hpp"
