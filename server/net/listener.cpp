#include "net/listener.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <stdexcept>
#include <utility>

namespace heliograph::net {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

Listener::Listener(asio::io_context& io, std::string address, std::uint16_t port,
                   OnAccept on_accept)
    : address_(std::move(address)), on_accept_(std::move(on_accept)), acceptor_(io), retry_(io) {
  try {
    tcp::resolver resolver(io);
    const auto found = resolver.resolve(address_, std::to_string(port), tcp::resolver::passive);
    const tcp::endpoint endpoint = found.begin()->endpoint();
    acceptor_.open(endpoint.protocol());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));
    acceptor_.bind(endpoint);
    acceptor_.listen();
  } catch (const boost::system::system_error& failure) {
    throw std::runtime_error(
        fmt::format("cannot listen on {}:{}: {}", address_, port, failure.code().message()));
  }
}

std::string Listener::url(const std::string& scheme) const {
  const bool v6 = address_.find(':') != std::string::npos;
  return fmt::format("{}://{}:{}/", scheme, v6 ? "[" + address_ + "]" : address_,
                     acceptor_.local_endpoint().port());
}

void Listener::accept() {
  if (waits_ || !acceptor_.is_open()) return;
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    waits_ = false;
    if (error == asio::error::operation_aborted || !acceptor_.is_open()) return;
    if (!error) on_accept_(std::move(socket));
    // Out of file descriptors: retry later.
    if (error && error != asio::error::connection_aborted) {
      spdlog::warn("cannot accept a connection: {}", error.message());
      retry_.expires_after(std::chrono::milliseconds(100));
      retry_.async_wait([this](error_code) {
        waits_ = false;
        accept();
      });
      waits_ = true;
      return;
    }
    accept();
  });
  waits_ = true;
}

void Listener::close() {
  error_code ignored;
  acceptor_.close(ignored);
  retry_.cancel();
}

}  // namespace heliograph::net
