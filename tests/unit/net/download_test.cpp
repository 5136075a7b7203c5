#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "net/download/byte_range.hpp"
#include "net/download/content.hpp"
#include "net/download/zip_archive.hpp"

namespace heliograph::net {
namespace {

class Download : public testing::Test {
 protected:
  Download() { std::ofstream(file_, std::ios::binary) << "0123456789"; }
  ~Download() override { std::filesystem::remove(file_); }

  /// abc0123456789def
  Content content() const {
    Content content;
    content.add("abc");
    content.add_file(file_, 10);
    content.add("def");
    return content;
  }

  static std::string read(const Content& content) {
    ContentReader reader(content);
    std::string text;
    std::array<char, 4> buffer{};
    while (const std::size_t bytes = reader.read(buffer)) text.append(buffer.data(), bytes);
    return text;
  }

  HttpResponse ask(const std::string& name, const std::string& value,
                   const std::string& method = "GET") const {
    HttpRequest request;
    request.method = method;
    request.headers = {{name, value}, {"if-range", if_range_}};
    HttpResponse whole;
    whole.headers = {{"ETag", "\"v1\""}};
    whole.content = content();
    return requested_part(request, std::move(whole));
  }

  static std::string header(const HttpResponse& response, const std::string& name) {
    for (const auto& [key, value] : response.headers) {
      if (key == name) return value;
    }
    return {};
  }

  const std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) / ("download" + std::to_string(getpid()));
  std::string if_range_;
};

TEST_F(Download, TemporaryFilesLastAsLongAsTheirParts) {
  auto owner = std::make_shared<int>(0);
  const std::weak_ptr<int> lasts = owner;
  Content part;
  {
    Content whole;
    whole.add_file(file_, 10, std::move(owner));
    part = whole.part(2, 3);
  }
  EXPECT_FALSE(lasts.expired());
  EXPECT_EQ(read(part), "234");
  part = {};
  EXPECT_TRUE(lasts.expired());
}

TEST_F(Download, EveryPartIsThatOfTheWhole) {
  const Content whole = content();
  const std::string text = read(whole);
  EXPECT_EQ(text, "abc0123456789def");
  for (std::size_t first = 0; first <= text.size(); ++first) {
    for (std::size_t size = 0; first + size <= text.size(); ++size) {
      const Content part = whole.part(first, size);
      EXPECT_EQ(part.size(), size);
      EXPECT_EQ(read(part), text.substr(first, size)) << first;
    }
  }
  EXPECT_EQ(read(whole.part(2, 6).part(2, 3)), "123");
}

TEST_F(Download, AFileThatEndsEarlyIsAnError) {
  std::ofstream(file_, std::ios::binary) << "01234";
  EXPECT_THROW(read(content()), std::runtime_error);
  std::filesystem::remove(file_);
  EXPECT_THROW(read(content()), std::runtime_error);
}

TEST_F(Download, OneRangeIsAPart) {
  const std::pair<const char*, const char*> parts[] = {
      {"bytes=0-0", "0-0"},   {"bytes=2-4", "2-4"},
      {"bytes=14-", "14-15"}, {"bytes=3-999", "3-15"},
      {"bytes=-3", "13-15"},  {"bytes=-99", "0-15"},
      {"BYTES= 5-6 ", "5-6"}, {"bytes=0-99999999999999999999999", "0-15"}};
  const std::string text = read(content());
  for (const auto& [range, expected] : parts) {
    const HttpResponse answer = ask("range", range);
    EXPECT_EQ(answer.status, 206) << range;
    EXPECT_EQ(header(answer, "Content-Range"), "bytes " + std::string(expected) + "/16");
    const std::size_t first = std::stoul(expected);
    EXPECT_EQ(read(*answer.content), text.substr(first, answer.content->size()));
  }
}

TEST_F(Download, ARangeBeyondTheEndCannotBeSatisfied) {
  for (const char* const range :
       {"bytes=16-", "bytes=99-100", "bytes=-0", "bytes=99999999999999999999999-"}) {
    const HttpResponse answer = ask("range", range);
    EXPECT_EQ(answer.status, 416) << range;
    EXPECT_EQ(header(answer, "Content-Range"), "bytes */16");
    EXPECT_FALSE(answer.content);
  }
}

TEST_F(Download, WhatIsNoRangeIsIgnored) {
  for (const char* const range : {"", "bytes", "bytes=", "bytes=-", "bytes=4-2", "bytes=a-b",
                                  "bytes=0-1,4-5", "lines=0-1", "bytes=0-1x"}) {
    const HttpResponse answer = ask("range", range);
    EXPECT_EQ(answer.status, 200) << range;
    EXPECT_EQ(answer.content->size(), 16u);
    EXPECT_EQ(header(answer, "Accept-Ranges"), "bytes");
  }
  EXPECT_EQ(ask("range", "bytes=0-1", "HEAD").status, 200);
}

TEST_F(Download, ARangeOfAnotherVersionIsTheWhole) {
  if_range_ = "\"v0\"";
  EXPECT_EQ(ask("range", "bytes=0-1").status, 200);
  if_range_ = "\"v1\"";
  EXPECT_EQ(ask("range", "bytes=0-1").status, 206);
}

TEST_F(Download, WhatTheClientHasIsNotSentAgain) {
  EXPECT_EQ(ask("if-none-match", "\"v0\", \"v1\"").status, 304);
  EXPECT_EQ(ask("if-none-match", "\"v0\"").status, 200);
}

TEST_F(Download, LargeArchivesHaveZip64Records) {
  const std::string end("PK\6\6", 4);
  const auto directory = [](const Content& archive) { return archive.segments().back().bytes; };
  const ZipEntry small{.name = "a", .file = file_, .bytes = 10, .crc = 1};
  EXPECT_EQ(directory(zip_archive({small}, 0)).find(end), std::string::npos);
  const ZipEntry large{.name = "b", .file = file_, .bytes = 5ull << 30, .crc = 1};
  const Content archive = zip_archive({large, small}, 0);
  EXPECT_NE(directory(archive).find(end), std::string::npos);
  // Both local headers, the first with sizes of 64 bits, and the files.
  EXPECT_EQ(archive.size() - directory(archive).size(), (31 + 20 + large.bytes) + (31 + 10));
  const Content many = zip_archive(std::vector<ZipEntry>(65535, small), 0);
  EXPECT_NE(directory(many).find(end), std::string::npos);
}

}  // namespace
}  // namespace heliograph::net
