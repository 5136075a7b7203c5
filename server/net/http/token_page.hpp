#pragma once

#include "net/http/http_message.hpp"

namespace heliograph::net {

/// Whether a browser asks for the page, and not a program for a resource.
bool asks_for_page(const HttpRequest& request);

/// A page in the place of a refusal by check of tokens: it says whether the token is missing, wrong
/// or refused for now, and has a field for one. The request's other parameters are kept.
HttpResponse token_page(const HttpRequest& request, HttpResponse refusal);

}  // namespace heliograph::net
