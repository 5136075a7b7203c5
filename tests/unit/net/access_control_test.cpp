#include "net/security/access_control.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "net/security/rate_limit.hpp"

namespace heliograph::net {
namespace {

HttpRequest request(std::map<std::string, std::string> headers) {
  return {.method = "GET", .path = "/", .query = {}, .headers = std::move(headers), .body = {}};
}

int status(const AccessControl& access, std::map<std::string, std::string> headers) {
  const Admission admission = access.admit(request(std::move(headers)));
  return admission.refusal ? admission.refusal->status : 200;
}

TEST(AccessControl, NonLoopbackAddressesNeedATokenOrInsecure) {
  for (const char* address : {"0.0.0.0", "::", "192.168.1.5", "example.org", "127.evil.example"}) {
    EXPECT_THROW(AccessControl({.bind_address = address}), std::invalid_argument) << address;
    EXPECT_NO_THROW(AccessControl({.bind_address = address, .insecure = true}));
    EXPECT_NO_THROW(AccessControl({.bind_address = address, .tokens = {{"0123456789"}}}));
  }
  for (const char* address : {"127.0.0.1", "127.0.0.2", "::1", "localhost"}) {
    EXPECT_NO_THROW(AccessControl({.bind_address = address})) << address;
  }
}

TEST(AccessControl, TokensMustBeLongEnoughAndValidInHeaders) {
  for (const char* token :
       {"short", "has space 123", "semicolon;123", "new\nline12", "quote\"123"}) {
    EXPECT_THROW(TokenSet({{token}}), std::invalid_argument) << token;
  }
}

TEST(AccessControl, AllowedOriginsMustBeOrigins) {
  for (const char* origin : {"example.org", "ftp://example.org", "https://example.org/path",
                             "https://", "https://user@example.org", "null", "*"}) {
    EXPECT_THROW(AccessControl({.allowed_origins = {origin}}), std::invalid_argument) << origin;
  }
}

TEST(AccessControl, AnyAddressIsAHostNameIfAllInterfacesAreBound) {
  const AccessControl access({.bind_address = "0.0.0.0", .insecure = true});
  EXPECT_EQ(status(access, {{"host", "10.1.2.3:8080"}}), 200);
  EXPECT_EQ(status(access, {{"host", "[fe80::1]:8080"}}), 200);
  EXPECT_EQ(status(access, {{"host", "evil.example:8080"}}), 403);
  EXPECT_EQ(status(access, {{"host", "10.1.2.3.evil.example"}}), 403);
  EXPECT_EQ(status(access, {{"host", "10.1.2.3:1"}, {"origin", "http://10.1.2.3:1"}}), 200);
  EXPECT_EQ(status(access, {{"host", "10.1.2.3:1"}, {"origin", "http://10.1.2.3:2"}}), 403);
}

// What <img src> on a page of another origin sends: no Origin, but this.
TEST(AccessControl, ResourcesEmbeddedByOtherOriginsAreRejected) {
  const AccessControl access({.allowed_origins = {"https://good.example"}});
  const auto get = [&](std::string path, std::map<std::string, std::string> headers) {
    HttpRequest asked = request(std::move(headers));
    asked.path = std::move(path);
    const Admission admission = access.admit(asked);
    return admission.refusal ? admission.refusal->status : 200;
  };
  for (const char* site : {"cross-site", "same-site"}) {
    for (const char* path : {"/api/v1/sessions/main/stream.mjpg", "/metrics", "/app.js", "/"}) {
      EXPECT_EQ(get(path, {{"host", "localhost"}, {"sec-fetch-site", site}}), 403) << path;
    }
    EXPECT_EQ(
        get("/", {{"host", "localhost"}, {"sec-fetch-site", site}, {"sec-fetch-mode", "navigate"}}),
        200);
    EXPECT_EQ(
        get("/metrics",
            {{"host", "localhost"}, {"sec-fetch-site", site}, {"sec-fetch-mode", "navigate"}}),
        403);
    EXPECT_EQ(get("/health/live", {{"host", "localhost"}, {"sec-fetch-site", site}}), 200);
    EXPECT_EQ(
        get("/metrics",
            {{"host", "localhost"}, {"sec-fetch-site", site}, {"origin", "https://good.example"}}),
        200);
  }
  for (const char* site : {"none", "same-origin"}) {
    EXPECT_EQ(get("/metrics", {{"host", "localhost"}, {"sec-fetch-site", site}}), 200);
  }
}

TEST(AccessControl, BearerTokenOverridesTheEmbeddingCheckButACookieDoesNot) {
  const AccessControl access({.tokens = {{"correct-horse", Role::control}}});
  const std::map<std::string, std::string> elsewhere{{"host", "localhost"},
                                                     {"sec-fetch-site", "same-site"}};
  auto bearer = elsewhere;
  bearer["authorization"] = "Bearer correct-horse";
  HttpRequest asked = request(bearer);
  asked.path = "/metrics";
  EXPECT_FALSE(access.admit(asked).refusal);
  auto cookie = elsewhere;
  cookie["cookie"] = "heliograph_token=correct-horse";
  asked = request(cookie);
  asked.path = "/metrics";
  EXPECT_EQ(access.admit(asked).refusal->status, 403);
}

// Browsers show no token when they ask beforehand.
TEST(AccessControl, PreflightOfAllowedOriginsNeedsNoToken) {
  const AccessControl access(
      {.tokens = {{"correct-horse", Role::control}}, .allowed_origins = {"https://good.example"}});
  HttpRequest asked = request({{"host", "localhost"},
                               {"origin", "https://good.example"},
                               {"access-control-request-method", "POST"}});
  EXPECT_FALSE(access.preflight(asked));
  asked.method = "OPTIONS";
  ASSERT_TRUE(access.preflight(asked));
  EXPECT_EQ(access.preflight(asked)->status, 204);
  EXPECT_EQ(access.preflight(asked)->headers.front(),
            (Headers::value_type{"Access-Control-Allow-Methods", "GET, HEAD, POST, PUT, DELETE"}));
  EXPECT_EQ(access.admit(asked).refusal->status, 401);
  asked.headers["origin"] = "https://evil.example";
  EXPECT_FALSE(access.preflight(asked));
}

TEST(TokenSet, ComparesTokensWhole) {
  const TokenSet tokens({{"correct-horse", Role::control}, {"only-watching", Role::view}});
  EXPECT_EQ(tokens.role_of("correct-horse"), Role::control);
  EXPECT_EQ(tokens.role_of("only-watching"), Role::view);
  for (const char* wrong :
       {"", "c", "correct-hors", "correct-horse1", "correct-horsf", "correct-horsecorrect-horse"}) {
    EXPECT_FALSE(tokens.role_of(wrong)) << wrong;
  }
  EXPECT_FALSE(TokenSet({}).role_of("")) << "no token is no empty token";
  EXPECT_THROW(TokenSet({{"correct-horse"}, {"correct-horse", Role::view}}), std::invalid_argument);
}

TEST(AccessControl, GivesTheRoleOfTheToken) {
  const AccessControl access({.tokens = {{"correct-horse"}, {"only-watching", Role::view}}});
  const auto role = [&](const char* token) {
    return access.admit(request({{"host", "h"}, {"authorization", std::string("Bearer ") + token}}))
        .role;
  };
  EXPECT_EQ(role("correct-horse"), Role::control);
  EXPECT_EQ(role("only-watching"), Role::view);
  EXPECT_EQ(AccessControl({}).admit(request({{"host", "localhost"}})).role, Role::control);
}

TEST(AccessControl, RejectsClientsThatGuessTokens) {
  const AccessControl access({.tokens = {{"correct-horse"}}});
  const auto guess = [&](const std::string& peer, const std::string& token) {
    HttpRequest asked = request({{"host", "h"}, {"authorization", "Bearer " + token}});
    asked.peer = peer;
    const Admission admission = access.admit(asked);
    return admission.refusal ? admission.refusal->status : 200;
  };
  int refused = 0;
  for (int i = 0; i < 40; ++i) refused += guess("10.0.0.1", "guess-" + std::to_string(i)) == 401;
  EXPECT_EQ(refused, 20);
  EXPECT_EQ(guess("10.0.0.1", "correct-horse"), 429) << "even the right one, or it would be found";
  EXPECT_EQ(guess("10.0.0.2", "correct-horse"), 200);
  HttpRequest silent = request({{"host", "h"}});
  silent.peer = "10.0.0.1";
  EXPECT_EQ(access.admit(silent).refusal->status, 401) << "showing none is no guess";
}

TEST(AccessControl, AllTokensOfARequestCountAsOneGuess) {
  const AccessControl access({.tokens = {{"correct-horse"}}});
  std::string cookies;
  for (int i = 0; i < 100; ++i) cookies += "heliograph_token=guess" + std::to_string(i) + "; ";
  cookies += "heliograph_token=correct-horse";
  EXPECT_EQ(status(access, {{"host", "h"}, {"cookie", cookies}}), 401);
}

TEST(AccessControl, UsesForwardedHeadersOfTrustedProxiesOnly) {
  const AccessControl access({.trusted_proxies = {"10.0.0.0/8", "::1"}});
  const auto client = [&](const std::string& peer, const std::string& chain) {
    HttpRequest asked = request({{"x-forwarded-for", chain}, {"x-forwarded-proto", "https"}});
    asked.peer = peer;
    return access.client_of(asked) + (access.is_secure(asked) ? " secure" : "");
  };
  EXPECT_EQ(client("192.0.2.1", "1.2.3.4"), "192.0.2.1");
  EXPECT_EQ(client("10.1.1.1", "1.2.3.4"), "1.2.3.4 secure");
  EXPECT_EQ(client("::1", "6.6.6.6, 1.2.3.4, 10.2.2.2"), "1.2.3.4 secure");
  EXPECT_EQ(client("10.1.1.1", "1.2.3.4:5678"), "1.2.3.4 secure");
  EXPECT_EQ(client("10.1.1.1", "1.2.3.4, <script>"), "10.1.1.1 secure");
  EXPECT_THROW(AccessControl({.trusted_proxies = {"10.0.0.0/33"}}), std::invalid_argument);
  EXPECT_THROW(AccessControl({.trusted_proxies = {"proxy"}}), std::invalid_argument);
}

TEST(AccessControl, CookieAttributesFollowTheConnection) {
  const AccessControl access({.tokens = {{"correct-horse"}}});
  HttpRequest asked = request({{"host", "h"}});
  EXPECT_EQ(access.token_cookie("t", asked),
            "heliograph_token=t; Path=/; HttpOnly; SameSite=Strict");
  asked.secure = true;
  EXPECT_EQ(access.token_cookie("t", asked),
            "heliograph_token=t; Path=/; HttpOnly; Secure; SameSite=Strict");
}

TEST(AccessControl, PlainHttpPagesOfTheSameHostAreCrossOriginForTls) {
  const AccessControl access({});
  HttpRequest asked = request({{"host", "localhost:1"}, {"origin", "http://localhost:1"}});
  EXPECT_FALSE(access.admit(asked).refusal);
  asked.secure = true;
  EXPECT_TRUE(access.admit(asked).refusal);
}

TEST(AddressRange, ContainsByBits) {
  EXPECT_TRUE(AddressRange("10.0.0.0/8").contains("10.255.0.1"));
  EXPECT_FALSE(AddressRange("10.0.0.0/8").contains("11.0.0.1"));
  EXPECT_TRUE(AddressRange("10.0.0.0/8").contains("::ffff:10.0.0.1"));
  EXPECT_TRUE(AddressRange("192.168.1.128/25").contains("192.168.1.129"));
  EXPECT_FALSE(AddressRange("192.168.1.128/25").contains("192.168.1.127"));
  EXPECT_TRUE(AddressRange("fd00::/8").contains("fd12::1"));
  EXPECT_FALSE(AddressRange("fd00::/8").contains("10.0.0.1"));
  EXPECT_TRUE(AddressRange("0.0.0.0/0").contains("8.8.8.8"));
}

TEST(ConnectionLimits, CountInTotalAndPerClient) {
  ConnectionLimits limits(4, 2, {AddressRange("10.0.0.0/8")});
  auto first = limits.take("1.1.1.1");
  auto second = limits.take("1.1.1.1");
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(limits.take("1.1.1.1"));
  auto proxy = limits.take("10.0.0.1");
  auto again = limits.take("10.0.0.1");
  EXPECT_TRUE(proxy && again);
  EXPECT_FALSE(limits.take("2.2.2.2")) << "full in all";
  first.reset();
  EXPECT_TRUE(limits.take("1.1.1.1"));
  EXPECT_EQ(limits.open(), 3u);
}

TEST(ConnectionLimits, Ipv6NetworkCountsAsOneClient) {
  EXPECT_EQ(client_key("2001:db8:1:2::3"), client_key("2001:db8:1:2:ffff::"));
  EXPECT_NE(client_key("2001:db8:1:2::3"), client_key("2001:db8:1:3::3"));
  EXPECT_NE(client_key("10.0.0.1"), client_key("10.0.0.2"));
}

TEST(AccessControl, TakesTheTokenFromHeaderCookieOrSubprotocol) {
  const AccessControl access({.tokens = {{"correct-horse"}}});
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
