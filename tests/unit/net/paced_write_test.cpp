#include "net/websocket/paced_write.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/string_body.hpp>
#include <optional>
#include <thread>
#include <vector>

#include "net/client_stream.hpp"

namespace heliograph::net {
namespace {

using namespace std::chrono_literals;
using boost::asio::ip::tcp;
using Response = boost::beast::http::response<boost::beast::http::string_body>;

struct Reading {
  std::size_t bytes_at_once;
  std::chrono::milliseconds pause;
};

/// The result of writing `size` bytes to a client with this reading rate, over real sockets with
/// small buffers.
struct Outcome {
  boost::system::error_code error;
  std::size_t received = 0;
  std::chrono::duration<double> seconds{};
};

Outcome write_to(const Reading& reading, std::size_t size, Pace pace) {
  boost::asio::io_context io;
  tcp::acceptor acceptor(io, {boost::asio::ip::address_v4::loopback(), 0});
  tcp::socket reader(io);
  reader.open(tcp::v4());
  reader.set_option(boost::asio::socket_base::receive_buffer_size(16 * 1024));
  reader.connect(acceptor.local_endpoint());
  tcp::socket writer = acceptor.accept();
  writer.set_option(boost::asio::socket_base::send_buffer_size(16 * 1024));
  ConnectionLimits limits(1, 1, {});
  ClientStream stream(std::move(writer), *limits.take("127.0.0.1"));

  Response response;
  response.body().assign(size, 'x');
  response.prepare_payload();
  boost::beast::http::response_serializer<boost::beast::http::string_body> serializer(response);

  Outcome outcome;
  std::atomic<bool> over = false;
  std::thread reads([&] {
    std::vector<char> space(reading.bytes_at_once);
    boost::system::error_code error;
    while (!error) {
      if (!over) std::this_thread::sleep_for(reading.pause);
      outcome.received += reader.read_some(boost::asio::buffer(space), error);
    }
  });
  const auto begin = PaceKeeper::Clock::now();
  write_paced(stream, serializer, PaceKeeper(pace, begin), [&](boost::system::error_code error) {
    outcome.error = error;
    over = true;
    stream.next_layer().close();
  });
  io.run();
  outcome.seconds = PaceKeeper::Clock::now() - begin;
  reads.join();
  return outcome;
}

TEST(PacedWrite, MayTakeLongerThanTheTimeoutOfOnePiece) {
  const Outcome outcome = write_to({.bytes_at_once = 8192, .pause = 15ms}, 600'000,
                                   {.timeout = 400ms, .bytes_per_second = 1000.0});
  EXPECT_FALSE(outcome.error) << outcome.error.message();
  EXPECT_GT(outcome.received, 600'000u);
  EXPECT_GT(outcome.seconds, 600ms);
}

TEST(PacedWrite, EndsIfNothingIsRead) {
  const Outcome outcome = write_to({.bytes_at_once = 8192, .pause = 900ms}, 4'000'000,
                                   {.timeout = 300ms, .bytes_per_second = 1000.0});
  EXPECT_EQ(outcome.error, boost::beast::error::timeout);
  EXPECT_LT(outcome.received, 4'000'000u);
}

TEST(PacedWrite, EndsIfTooLittleIsRead) {
  const Outcome outcome = write_to({.bytes_at_once = 2048, .pause = 20ms}, 4'000'000,
                                   {.timeout = 500ms, .bytes_per_second = 1e6});
  EXPECT_EQ(outcome.error, boost::beast::error::timeout);
  EXPECT_LT(outcome.received, 4'000'000u);
}

}  // namespace
}  // namespace heliograph::net
