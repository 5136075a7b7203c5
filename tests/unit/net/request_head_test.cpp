#include "net/http/request_head.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace heliograph::net {
namespace {

using namespace std::string_view_literals;

std::string get(const std::string& headers, const std::string& version = "1.1") {
  return "GET / HTTP/" + version + "\r\n" + headers + "\r\n";
}

std::string_view fault(const std::string& request) {
  return examine_request_head(request).fault;
}

TEST(RequestHead, EndsWithItsEmptyLine) {
  const std::string head = get("Host: a\r\n");
  EXPECT_EQ(examine_request_head(head + "body\nof any\rbytes").length, head.size());
  for (std::size_t size = 0; size < head.size(); ++size) {
    const RequestHead part = examine_request_head(head.substr(0, size));
    EXPECT_EQ(part.length, 0u) << size;
    EXPECT_EQ(part.fault, "") << size;
  }
}

TEST(RequestHead, OrdinaryRequestsAreFaultless) {
  for (const char* const headers :
       {"Host: a\r\n", "HOST:a.example:8080\r\n", "Host: [::1]:8080\r\n", "Host:\r\n",
        "Host: a\r\nContent-Length: 12\r\n", "Host: a\r\nTransfer-Encoding: Chunked\r\n",
        "Host: a\r\nCookie: x=1\r\nCookie: y=2\r\n", "Host: a\r\nX: \t spaced \t\r\n"}) {
    EXPECT_EQ(fault(get(headers)), "") << headers;
  }
  EXPECT_EQ(fault(get("", "1.0")), "") << "HTTP/1.0 needs no Host";
}

TEST(RequestHead, AmbiguousHeadersAreFaults) {
  for (const auto& [headers, word] : {
           std::pair{"Host: a\r\nhost: b\r\n", "more than one Host"},
           std::pair{"Host: a\r\nHost: a\r\n", "more than one Host"},
           std::pair{"Accept: */*\r\n", "no Host"},
           std::pair{"Host: a, b\r\n", "name or an address"},
           std::pair{"Host: a/b\r\n", "name or an address"},
           std::pair{"Host: user@a\r\n", "name or an address"},
           std::pair{"Host: a\r\nContent-Length: 1\r\nContent-Length: 1\r\n", "more than one"},
           std::pair{"Host: a\r\nContent-Length: 1, 1\r\n", "a number"},
           std::pair{"Host: a\r\nContent-Length: +1\r\n", "a number"},
           std::pair{"Host: a\r\nContent-Length:\r\n", "a number"},
           std::pair{"Host: a\r\nContent-Length: 1\r\nTransfer-Encoding: chunked\r\n", "both"},
           std::pair{"Host: a\r\nTransfer-Encoding: chunked\r\nContent-Length: 1\r\n", "both"},
           std::pair{"Host: a\r\nTransfer-Encoding: chunked, gzip\r\n", "must be chunked"},
           std::pair{"Host: a\r\nTransfer-Encoding: identity\r\n", "must be chunked"},
           std::pair{"Host: a\r\nTransfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
                     "must be chunked"},
           std::pair{"Host: a\r\n folded\r\n", "one line"},
           std::pair{"Host: a\r\nX: b\r\n\tfolded\r\n", "one line"},
           std::pair{" Host: a\r\n", "one line"},
       }) {
    EXPECT_NE(fault(get(headers)).find(word), std::string_view::npos)
        << headers << " -> " << fault(get(headers));
  }
  EXPECT_NE(fault(get("Transfer-Encoding: chunked\r\n", "1.0")), "");
}

TEST(RequestHead, BareLineEndsAreFaultsBeforeTheHeadIsWhole) {
  EXPECT_NE(fault("GET / HTTP/1.1\nHost: a\n"), "");
  EXPECT_NE(fault("\nGET / HTTP/1.1\r\n"), "");
  EXPECT_NE(fault("GET / HTTP/1.1\r\nHost: a\rX: b"), "");
  EXPECT_NE(fault("GET / HTTP/1.1\r\nHost: a\r\r\n\r\n"), "");
  EXPECT_EQ(fault("GET / HTTP/1.1\r"), "") << "its line feed may follow";
}

TEST(RequestHead, ChunkExtensionsMayNotEndTheirLineElsewhere) {
  for (const char* const plain : {"", ";a=b", ";a=\"b c\"", ";\ta"}) {
    EXPECT_TRUE(is_plain_chunk_extension(plain)) << plain;
  }
  for (const std::string_view other : {";a=\nb"sv, ";a=\"\n\""sv, ";a=\rb"sv, ";\0"sv}) {
    EXPECT_FALSE(is_plain_chunk_extension(other)) << other;
  }
}

}  // namespace
}  // namespace heliograph::net
