#pragma once

#include <boost/asio/ssl/context.hpp>
#include <filesystem>
#include <memory>

// For the sources of this folder only: it brings Boost.

namespace heliograph::net {

struct TlsFiles {
  std::filesystem::path certificate;  // PEM, the server's first, then those that signed it
  std::filesystem::path key;          // PEM
};

/// The certificate that connections are secured with, TLS 1.2 or newer.
class TlsCertificate {
 public:
  /// @throws std::runtime_error naming the file that is wrong
  explicit TlsCertificate(TlsFiles files);

  std::shared_ptr<boost::asio::ssl::context> context() const { return context_; }
  /// Reads the files again, for new connections. @throws like the constructor; then the old
  /// certificate stays in use.
  void reload();

 private:
  const TlsFiles files_;
  std::shared_ptr<boost::asio::ssl::context> context_;
};

}  // namespace heliograph::net
