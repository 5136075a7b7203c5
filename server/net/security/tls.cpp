#include "net/security/tls.hpp"

#include <openssl/ssl.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace heliograph::net {
namespace {

namespace ssl = boost::asio::ssl;
using boost::system::error_code;

void check(const error_code& error, const char* what, const std::filesystem::path& file) {
  if (!error) return;
  throw std::runtime_error(std::string(what) + " " + file.string() +
                           " cannot be used: " + error.message());
}

std::shared_ptr<ssl::context> read(const TlsFiles& files) {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  context->set_options(ssl::context::default_workarounds | ssl::context::single_dh_use);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  // Of TLS 1.2 only ciphers with forward secrecy and authentication, as in 1.3.
  SSL_CTX_set_cipher_list(context->native_handle(), "ECDHE+AESGCM:ECDHE+CHACHA20");
  // Renegotiation would let a client make the server sign without limit on one connection.
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
  // A key with a passphrase would stop the server at a prompt.
  context->set_password_callback(
      [](std::size_t, ssl::context::password_purpose) { return std::string(); });
  error_code error;
  context->use_certificate_chain_file(files.certificate.string(), error);
  check(error, "the certificate", files.certificate);
  context->use_private_key_file(files.key.string(), ssl::context::pem, error);
  check(error, "the key", files.key);
  return context;
}

}  // namespace

TlsCertificate::TlsCertificate(TlsFiles files) : files_(std::move(files)), context_(read(files_)) {}

void TlsCertificate::reload() {
  context_ = read(files_);
}

}  // namespace heliograph::net
