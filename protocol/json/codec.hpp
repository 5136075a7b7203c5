#pragma once

#include "protocol/json/raw_json.hpp"
#include "protocol/messages/messages.hpp"

// Messages to JSON and back. These templates are instantiated in codec.cpp for every message of
// the protocol (one line there for a new one), so that nobody else compiles the JSON library.

namespace heliograph::protocol {

/// Reads a message. Unknown members are ignored; a missing, ill-typed or out-of-range member gives
/// ErrorCode::invalid_params with its path ("cameras[2].eye"), the reason and the limit.
template <class T>
Result<T> decode(const RawJson& json);

template <class T>
RawJson encode(const T& message);

/// JSON Schema 2020-12 of a message.
template <class T>
RawJson schema_of();

}  // namespace heliograph::protocol
