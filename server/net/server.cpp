#include "net/server.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/strand.hpp>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "net/connection.hpp"

namespace heliograph::net {

using asio::ip::tcp;
using boost::system::error_code;

struct Server::State {
  State(session::SessionHost& host, const ServerOptions& options)
      : access(options.access), router(host, access), address(options.access.bind_address) {
    listen(options.port);
    stop_signals.add(SIGINT);
    stop_signals.add(SIGTERM);
    context = std::make_unique<ServerContext>(ServerContext{
        .host = host, .access = access, .router = router, .io = io, .connections = {}});
  }

  void listen(std::uint16_t port) {
    try {
      tcp::resolver resolver(io);
      const auto found = resolver.resolve(address, std::to_string(port), tcp::resolver::passive);
      const tcp::endpoint endpoint = found.begin()->endpoint();
      acceptor.open(endpoint.protocol());
      acceptor.set_option(tcp::acceptor::reuse_address(true));
      acceptor.bind(endpoint);
      acceptor.listen();
    } catch (const boost::system::system_error& failure) {
      throw std::runtime_error(
          fmt::format("cannot listen on {}:{}: {}", address, port, failure.code().message()));
    }
  }

  void accept() {
    acceptor.async_accept(asio::make_strand(io), [this](error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted || context->draining) return;
      if (!error) welcome(std::move(socket));
      // Out of descriptors: wait for some to come back instead of trying in a circle.
      if (error && error != asio::error::connection_aborted) {
        spdlog::warn("cannot accept a connection: {}", error.message());
        retry.expires_after(std::chrono::milliseconds(100));
        retry.async_wait([this](error_code) { accept(); });
        return;
      }
      accept();
    });
  }

  void welcome(tcp::socket socket) {
    if (context->connections.size() >= most_connections) {
      spdlog::warn("a connection was refused: {} are open", most_connections);
      return;
    }
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    // Small, so that a finished write means the picture is nearly there.
    socket.set_option(asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
    start_http_connection(*context, std::move(socket));
  }

  void wait_for_signal() {
    stop_signals.async_wait([this](error_code error, int signal) {
      if (error) return;
      spdlog::info("shutting down after {}", signal == SIGINT ? "SIGINT" : "SIGTERM");
      drain();
      stop_signals.async_wait([](error_code again, int) {
        if (!again) std::_Exit(EXIT_FAILURE);
      });
    });
  }

  void drain() {
    if (std::exchange(context->draining, true)) return;
    router.drain();
    error_code ignored;
    acceptor.close(ignored);
    if (context->connections.empty()) return io.stop();
    // Ending a connection takes it out of the set.
    const std::set<Connection*> open = context->connections;
    for (Connection* connection : open) connection->shut_down();
    deadline.expires_after(drain_deadline);
    deadline.async_wait([this](error_code) { io.stop(); });
  }

  AccessControl access;
  Router router;
  std::string address;
  std::unique_ptr<ServerContext> context;  // outlives the connections that `io` still holds
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer retry{io};
  asio::steady_timer deadline{io};
  asio::signal_set stop_signals{io};
};

Server::Server(session::SessionHost& host, const ServerOptions& options)
    : state_(std::make_unique<State>(host, options)) {}

Server::~Server() = default;

std::string Server::url() const {
  const auto port = state_->acceptor.local_endpoint().port();
  const std::string& address = state_->address;
  const bool v6 = address.find(':') != std::string::npos;
  return fmt::format("http://{}:{}/", v6 ? "[" + address + "]" : address, port);
}

void Server::run() {
  state_->wait_for_signal();
  state_->accept();
  state_->io.run();
}

void Server::stop() {
  asio::post(state_->io, [this] { state_->drain(); });
}

}  // namespace heliograph::net
