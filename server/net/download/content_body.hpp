#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/optional.hpp>
#include <boost/system/error_code.hpp>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "net/download/content.hpp"

// For the sources of this module only: it brings Boost.

namespace heliograph::net {

/// A body of Beast that reads a Content while it is sent: the concepts Body and BodyWriter.
struct ContentBody {
  using value_type = Content;

  static std::uint64_t size(const Content& content) { return content.size(); }

  class writer {
   public:
    using const_buffers_type = boost::asio::const_buffer;

    template <bool is_request, class Fields>
    writer(const boost::beast::http::header<is_request, Fields>&, const Content& content)
        : reader_(content), left_(content.size()), buffer_(bytes_at_once) {}

    void init(boost::system::error_code& error) { error = {}; }

    boost::optional<std::pair<const_buffers_type, bool>> get(boost::system::error_code& error) {
      error = {};
      if (left_ == 0) return boost::none;
      try {
        const std::size_t bytes = reader_.read(buffer_);
        left_ -= bytes;
        return std::pair(const_buffers_type(buffer_.data(), bytes), left_ > 0);
      } catch (const std::runtime_error&) {
        error = make_error_code(boost::system::errc::io_error);
        return boost::none;
      }
    }

   private:
    static constexpr std::size_t bytes_at_once = 64 * 1024;

    ContentReader reader_;
    std::uint64_t left_;
    std::vector<char> buffer_;
  };
};

}  // namespace heliograph::net
