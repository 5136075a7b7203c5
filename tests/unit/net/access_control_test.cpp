#include "net/access_control.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "net/rate_limit.hpp"

namespace heliograph::net {
namespace {

HttpRequest request(std::map<std::string, std::string> headers) {
  return {.method = "GET", .path = "/", .query = {}, .headers = std::move(headers), .body = {}};
}

int status(const AccessControl& access, std::map<std::string, std::string> headers) {
  const auto refused = access.refusal(request(std::move(headers)));
  return refused ? refused->status : 200;
}

TEST(AccessControl, OtherAddressesThanLoopbackNeedATokenOrConsent) {
  for (const char* address : {"0.0.0.0", "::", "192.168.1.5", "example.org", "127.evil.example"}) {
    EXPECT_THROW(AccessControl({.bind_address = address}), std::invalid_argument) << address;
    EXPECT_NO_THROW(AccessControl({.bind_address = address, .insecure = true}));
    EXPECT_NO_THROW(AccessControl({.bind_address = address, .token = "0123456789"}));
  }
  for (const char* address : {"127.0.0.1", "127.0.0.2", "::1", "localhost"}) {
    EXPECT_NO_THROW(AccessControl({.bind_address = address})) << address;
  }
}

TEST(AccessControl, TokensMustBeLongEnoughAndFitIntoHeaders) {
  for (const char* token :
       {"short", "has space 123", "semicolon;123", "new\nline12", "quote\"123"}) {
    EXPECT_THROW(AccessControl({.token = token}), std::invalid_argument) << token;
  }
}

TEST(AccessControl, AllowedOriginsMustBeOrigins) {
  for (const char* origin : {"example.org", "ftp://example.org", "https://example.org/path",
                             "https://", "https://user@example.org", "null", "*"}) {
    EXPECT_THROW(AccessControl({.allowed_origins = {origin}}), std::invalid_argument) << origin;
  }
}

TEST(AccessControl, AnyAddressIsAHostNameWhereAnyInterfaceIsBound) {
  const AccessControl access({.bind_address = "0.0.0.0", .insecure = true});
  EXPECT_EQ(status(access, {{"host", "10.1.2.3:8080"}}), 200);
  EXPECT_EQ(status(access, {{"host", "[fe80::1]:8080"}}), 200);
  EXPECT_EQ(status(access, {{"host", "evil.example:8080"}}), 403);
  EXPECT_EQ(status(access, {{"host", "10.1.2.3.evil.example"}}), 403);
  EXPECT_EQ(status(access, {{"host", "10.1.2.3:1"}, {"origin", "http://10.1.2.3:1"}}), 200);
  EXPECT_EQ(status(access, {{"host", "10.1.2.3:1"}, {"origin", "http://10.1.2.3:2"}}), 403);
}

TEST(AccessControl, ComparesTokensWhole) {
  const AccessControl access({.token = "correct-horse"});
  EXPECT_TRUE(access.is_token("correct-horse"));
  for (const char* wrong :
       {"", "c", "correct-hors", "correct-horse1", "correct-horsf", "correct-horsecorrect-horse"}) {
    EXPECT_FALSE(access.is_token(wrong)) << wrong;
  }
  EXPECT_FALSE(AccessControl({}).is_token("")) << "no token is no empty token";
}

TEST(AccessControl, TakesTheTokenFromHeaderCookieOrSubprotocol) {
  const AccessControl access({.token = "correct-horse"});
  const std::string encoded = "Y29ycmVjdC1ob3JzZQ";
  EXPECT_EQ(status(access, {{"host", "h"}}), 401);
  EXPECT_EQ(status(access, {{"host", "h"}, {"authorization", "Bearer correct-horse"}}), 200);
  EXPECT_EQ(status(access, {{"host", "h"}, {"authorization", "Basic correct-horse"}}), 401);
  EXPECT_EQ(status(access, {{"host", "h"}, {"cookie", "a=b; heliograph_token=correct-horse"}}),
            200);
  EXPECT_EQ(status(access, {{"host", "h"}, {"cookie", "xheliograph_token=correct-horse"}}), 401);
  EXPECT_EQ(
      status(access, {{"host", "h"},
                      {"sec-websocket-protocol", "heliograph.v1, heliograph.v1.token." + encoded}}),
      200);
}

TEST(HttpMessage, QueriesAreDecoded) {
  const auto query = parse_query("a=1&b=x%20y+z&c&%64=%&e=%4");
  EXPECT_EQ(query.at("a"), "1");
  EXPECT_EQ(query.at("b"), "x y z");
  EXPECT_EQ(query.at("c"), "");
  EXPECT_EQ(query.at("d"), "%");
  EXPECT_EQ(query.at("e"), "%4");
}

TEST(RateLimit, AllowsABurstAndThenTheRate) {
  RateLimit::Clock::time_point now;
  RateLimit limit(10.0, 5.0, now);
  int allowed = 0;
  for (int i = 0; i < 20; ++i) allowed += limit.allow(now) ? 1 : 0;
  EXPECT_EQ(allowed, 5);
  for (int i = 0; i < 1000; ++i) {
    now += std::chrono::milliseconds(10);
    allowed += limit.allow(now) ? 1 : 0;
  }
  EXPECT_NEAR(allowed, 105, 1) << "ten seconds at ten a second";
  now += std::chrono::hours(1);
  for (int i = 0; i < 20; ++i) allowed += limit.allow(now) ? 1 : 0;
  EXPECT_NEAR(allowed, 110, 1) << "no more than a burst is saved up";
}

}  // namespace
}  // namespace heliograph::net
