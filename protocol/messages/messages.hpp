#pragma once

// Parameters and results of every method, and the notifications the server sends. What is declared
// in these files is all there is: parsing, validation, writing and the OpenRPC document come from
// each message's `fields()`.

#include "protocol/messages/annotation_messages.hpp"
#include "protocol/messages/bookmark_messages.hpp"
#include "protocol/messages/edit_messages.hpp"
#include "protocol/messages/frame_messages.hpp"
#include "protocol/messages/job_messages.hpp"
#include "protocol/messages/loading_messages.hpp"
#include "protocol/messages/material_messages.hpp"
#include "protocol/messages/measurement_messages.hpp"
#include "protocol/messages/membership_messages.hpp"
#include "protocol/messages/node_messages.hpp"
#include "protocol/messages/render_messages.hpp"
#include "protocol/messages/scene_messages.hpp"
#include "protocol/messages/section_messages.hpp"
#include "protocol/messages/session_messages.hpp"
#include "protocol/messages/stream_messages.hpp"
#include "protocol/messages/texture_messages.hpp"
