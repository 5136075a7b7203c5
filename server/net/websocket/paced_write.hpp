#pragma once

#include <algorithm>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <cstddef>
#include <utility>

#include "net/io_handler.hpp"

// For the sources of this folder only: it brings Boost.

namespace heliograph::net {

/// How slowly a client may read.
struct Pace {
  std::chrono::milliseconds timeout;  // without a single byte being read
  double bytes_per_second;            // in the long run, once `timeout` has passed
};

/// The deadline of a write: a large response may take long while its client keeps reading, but
/// reading single bytes does not extend it without limit.
class PaceKeeper {
 public:
  using Clock = std::chrono::steady_clock;

  PaceKeeper(Pace pace, Clock::time_point begin) : pace_(pace), begin_(begin) {}

  void took(std::size_t bytes) { taken_ += static_cast<double>(bytes); }
  /// When more must have been read.
  Clock::time_point deadline(Clock::time_point now) const {
    const std::chrono::duration<double> owed(taken_ / pace_.bytes_per_second);
    const auto whole = std::chrono::duration_cast<Clock::duration>(owed);
    return std::min(now + pace_.timeout, begin_ + pace_.timeout + whole);
  }

 private:
  Pace pace_;
  Clock::time_point begin_;
  double taken_ = 0.0;
};

/// Writes a message piece by piece, each within the time that the pace leaves it. `stream` and
/// `serializer` live until `done`, which gets the error code.
template <class Stream, class Serializer>
void write_paced(Stream& stream, Serializer& serializer, PaceKeeper keeper, IoHandler done) {
  stream.next_layer().expires_at(keeper.deadline(PaceKeeper::Clock::now()));
  boost::beast::http::async_write_some(
      stream, serializer,
      IoHandler([&stream, &serializer, keeper, done = std::move(done)](
                    boost::system::error_code error, std::size_t bytes) mutable {
        if (error || serializer.is_done()) return done(error);
        keeper.took(bytes);
        write_paced(stream, serializer, keeper, std::move(done));
      }));
}

}  // namespace heliograph::net
