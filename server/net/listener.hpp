#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <string>

// For the sources of this folder only: it brings Boost.

namespace heliograph::net {

/// One open port. Its connections run on the one network thread, like everything in this folder.
class Listener {
 public:
  using OnAccept = std::function<void(boost::asio::ip::tcp::socket)>;

  /// Opens the port; 0 takes a free one. @throws std::runtime_error
  Listener(boost::asio::io_context& io, std::string address, std::uint16_t port,
           OnAccept on_accept);

  /// "scheme://address:port/"
  std::string url(const std::string& scheme) const;
  /// Accepts until it is closed, or until accepting a connection throws: then it is called again.
  void accept();
  void close();

 private:
  const std::string address_;
  const OnAccept on_accept_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer retry_;
  bool waits_ = false;  // for a connection, or to retry
};

}  // namespace heliograph::net
