#pragma once

#include <string_view>

#include "protocol/json/jsonrpc.hpp"

namespace heliograph::protocol {

/// The methods as tools of the Model Context Protocol (revision 2025-06-18): text in, text out,
/// independent of the transport. A tool is called like its method, with underscores for dots, and
/// takes the same parameters. Methods that need a stream, and those that describe the protocol, are
/// no tools. Images come as images, which models can look at; failures of a method as results with
/// `isError`, so that a model reads the reason. May be used from any thread.
class McpServer {
 public:
  /// `dispatcher` must outlive this and all its pending calls. `version`: of the program.
  McpServer(const Dispatcher& dispatcher, std::string_view version)
      : dispatcher_(dispatcher), version_(version) {}

  /// Whether a revision of the protocol, such as "2025-06-18", is known.
  static bool knows(std::string_view revision);

  /// Handles one message. `reply` gets the response text, once; empty if there is none. It may be
  /// called later, on another thread. Does not throw.
  void handle(std::string_view text, const CallContext& context, Dispatcher::Reply reply) const;

 private:
  const Dispatcher& dispatcher_;
  std::string_view version_;
};

}  // namespace heliograph::protocol
