#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "net/connection.hpp"
#include "net/http/beast_messages.hpp"
#include "net/http/job_routes.hpp"
#include "net/http/request_head.hpp"
#include "net/http/response_writer.hpp"
#include "net/http/upload_requests.hpp"
#include "net/security/rate_limit.hpp"
#include "net/tcp_progress.hpp"
#include "net/websocket/upgrade_refusal.hpp"
#include "protocol/messages/messages.hpp"

namespace heliograph::net {
namespace {

namespace http = beast::http;
using boost::system::error_code;

std::string_view beast_view(beast::string_view text) {
  return {text.data(), text.size()};
}

/// "/api/v1/sessions/main/stream.mjpg" -> main
std::optional<std::string> mjpeg_stream_session(const HttpRequest& request) {
  constexpr std::string_view before = "/api/v1/sessions/";
  constexpr std::string_view after = "/stream.mjpg";
  const std::string_view path = request.path;
  const std::size_t around = before.size() + after.size();
  if (path.size() <= around || !path.starts_with(before) || !path.ends_with(after)) {
    return std::nullopt;
  }
  return std::string(path.substr(before.size(), path.size() - around));
}

constexpr std::size_t discarded_at_once = 16 * 1024;
constexpr std::size_t head_bytes_at_once = 4 * 1024;
// How often it is checked whether the client of an answer that is being made is still there.
constexpr std::chrono::milliseconds presence_interval{500};

class HttpConnection : public Connection, public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(ServerContext& context, ClientStream stream, ListenerKind kind)
      : context_(context),
        listener_kind_(kind),
        stream_(std::move(stream)),
        presence_timer_(stream_.get_executor()),
        calls_(calls_per_second, calls_at_once, RateLimit::Clock::now()) {
    context_.enter(*this);
  }
  ~HttpConnection() override { context_.leave(*this); }

  void start() {
    if (!context_.certificate || listener_kind_ == ListenerKind::metrics) return read();
    stream_.next_layer().expires_after(handshake_timeout);
    detect_tls(stream_, buffer_, [self = shared_from_this()](error_code error, bool tls) {
      if (error) return;
      tls ? self->secure() : self->read();
    });
  }

  void shut_down() override {
    shutting_down_ = true;
    if (answering_) return;
    // Ends the pending read.
    error_code ignored;
    stream_.next_layer().socket().shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
  }

 private:
  void secure() {
    stream_.async_secure(context_.certificate->context(), asio::ssl::stream_base::server,
                         buffer_.data(),
                         [self = shared_from_this()](error_code error, std::size_t used) {
                           if (error) return;
                           self->buffer_.consume(used);
                           self->read();
                         });
  }

  void read() {
    framing_ = {};
    headers_before_body_.reset();
    parser_.emplace();
    parser_->header_limit(max_request_head_bytes);
    // The head decides what the body may have.
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());
    // The first request has a short timeout, later ones of a kept-alive connection a longer one.
    stream_.next_layer().expires_after(std::exchange(first_, false) ? handshake_timeout
                                                                    : idle_timeout);
    read_head();
  }

  /// The head is examined as it came: the parser folds lines and merges repeated headers.
  void read_head() {
    const auto received = buffer_.data();
    const RequestHead head =
        examine_request_head({static_cast<const char*>(received.data()), received.size()});
    if (!head.fault.empty()) return refuse_head(head.fault);
    const std::size_t head_bytes = head.length > 0 ? head.length : received.size();
    if (head_bytes > max_request_head_bytes) return received_header(http::error::header_limit);
    if (head.length > 0) return parse_head(head.length);
    stream_.async_read_some(buffer_.prepare(head_bytes_at_once),
                            [self = shared_from_this()](error_code error, std::size_t bytes) {
                              self->buffer_.commit(bytes);
                              if (!error) return self->read_head();
                              const bool ended = error == asio::error::eof;
                              const bool begun = self->buffer_.size() > 0;
                              if (ended)
                                error = begun ? http::error::partial_message
                                              : http::error::end_of_stream;
                              self->received_header(error);
                            });
  }

  void parse_head(std::size_t length) {
    error_code error;
    buffer_.consume(parser_->put(asio::buffer(buffer_.data().data(), length), error));
    received_header(error);
  }

  void refuse_head(std::string_view fault) {
    framing_.keep_alive = false;
    send(text_response(400, fault));
  }

  std::size_t largest_body() const { return context_.host.dispatch_limits().max_message_bytes; }

  /// Manifests of jobs may be large, from clients that may create jobs.
  std::size_t largest_body_of_request() const {
    const auto& head = parser_->get();
    const bool job = head.method() == http::verb::post && beast_view(head.target()) == jobs_path;
    if (!job || !context_.host.jobs()) return largest_body();
    const Admission admission = context_.access.admit(to_request(BeastRequest(head), stream_));
    const bool may_create = !admission.refusal && admission.role == Role::control;
    return may_create ? max_job_bytes : largest_body();
  }

  void received_header(error_code error) {
    framing_.head_only = parser_->get().method() == http::verb::head;
    if (error) return received(error);
    const std::size_t largest = largest_body_of_request();
    if (context_.uploads && listener_kind_ == ListenerKind::main &&
        parser_->get().method() == http::verb::put) {
      return begin_upload();
    }
    if (parser_->content_length().value_or(0) > largest) return received(http::error::body_limit);
    parser_->body_limit(largest);
    // The parser adds trailers to the headers; they are not for that, RFC 9110 section 6.5.1.
    if (parser_->chunked()) {
      headers_before_body_ = parser_->get().base();
      parser_->on_chunk_header(examine_chunk_);
    }
    send_continue(parser_->get(), [self = shared_from_this()] {
      http::async_read(self->stream_, self->buffer_, *self->parser_,
                       IoHandler([self](error_code failed) { self->received(failed); }));
    });
  }

  /// Sends 100 Continue if the client waits for it before its body, RFC 9110 section 10.1.1.
  template <class Header>
  void send_continue(const Header& header, std::function<void()> next) {
    const bool asks =
        header.version() >= 11 && beast::iequals(header[http::field::expect], "100-continue");
    if (!asks) return next();
    constexpr std::string_view interim_response = "HTTP/1.1 100 Continue\r\n\r\n";
    write_all(stream_, WriteBuffers(asio::buffer(interim_response)),
              [next = std::move(next)](error_code error) {
                if (!error) next();
              });
  }

  /// Receives the body into a file, if the request is valid.
  void begin_upload() {
    framing_.keep_alive = false;
    answering_ = true;
    const HttpRequest request = to_request(BeastRequest(parser_->get()), stream_);
    framing_.cors = context_.access.cors_headers(request);
    if (auto refused = upload_.begin(request, *parser_)) return send(*std::move(refused));
    send_continue(upload_.head(), [self = shared_from_this()] {
      self->upload_.receive(self->stream_, self->buffer_,
                            [self](HttpResponse response) { self->send(std::move(response)); });
    });
  }

  void received(error_code error) {
    if (error == http::error::body_limit || error == http::error::header_limit) {
      framing_.keep_alive = false;
      return send(text_response(413, "The request is too large."));
    }
    if (!error) return answer_or_close();
    if (error == http::error::end_of_stream) return close();
    if (error.category() == http::make_error_code(http::error::bad_method).category()) {
      framing_.keep_alive = false;
      return send(text_response(400, "This is not an HTTP request."));
    }
    // Timed out or disconnected: no response can be sent.
  }

  /// Where there is no memory for the answer, the client may try again.
  void answer_or_close() {
    try {
      answer();
    } catch (const std::bad_alloc&) {
      give_up();
      throw;
    }
  }

  void give_up() {
    presence_timer_.cancel();
    if (stream_.has_socket()) stream_.next_layer().close();
  }

  void answer() {
    const bool upgrade = beast::websocket::is_upgrade(parser_->get());
    framing_.keep_alive =
        parser_->keep_alive() && !upgrade && !shutting_down_ && !context_.draining;
    answering_ = true;
    BeastRequest message = parser_->release();
    if (headers_before_body_) message.base() = *std::exchange(headers_before_body_, std::nullopt);
    const HttpRequest request = to_request(std::move(message), stream_);
    if (listener_kind_ == ListenerKind::metrics)
      return send(context_.router.answer_metrics_listener(request));
    framing_.cors = context_.access.cors_headers(request);
    if (context_.certificate && !request.secure) return send(to_https(request));
    if (upgrade) return become_viewer(request);
    if (!calls_.allow(RateLimit::Clock::now())) {
      return send(text_response(429, "Too many requests on this connection."));
    }
    if (auto allowed = context_.access.preflight(request)) return send(*std::move(allowed));
    if (const auto session = mjpeg_stream_session(request); session && request.method == "GET") {
      return start_mjpeg(request, *session);
    }
    if (context_.uploads && request.method == "DELETE" && upload_address(request.path)) {
      return send(delete_upload(context_, request));
    }
    stream_.next_layer().expires_never();
    const auto pending =
        std::make_shared<protocol::PendingAnswer>(max_outgoing_bytes, context_.answer_memory);
    watch_client(pending);
    context_.router.handle(request, pending,
                           [self = shared_from_this(), pending](HttpResponse response) {
                             self->send_later(std::move(response), pending);
                           });
  }

  /// From any thread.
  void send_later(HttpResponse response, const std::shared_ptr<protocol::PendingAnswer>& pending) {
    try {
      run_later(stream_.get_executor(),
                [self = shared_from_this(), pending, response = std::move(response)]() mutable {
                  self->presence_timer_.cancel();
                  self->send(std::move(response));
                });
    } catch (const std::bad_alloc&) {
      pending->abandon();  // watch_client() closes the connection
      throw;
    }
  }

  /// Gives the answer up once the client has closed the connection: its frames would be rendered in
  /// vain. A client that closes one direction only is told so in the answer.
  void watch_client(std::shared_ptr<protocol::PendingAnswer> answer) {
    presence_timer_.expires_after(presence_interval);
    on_expiry(presence_timer_,
              [self = shared_from_this(), answer = std::move(answer)](error_code error) mutable {
                if (error) return;
                if (answer->abandoned()) return self->give_up();
                if (peer_has_closed(self->stream_.next_layer().socket().native_handle())) {
                  return answer->abandon();
                }
                self->watch_client(std::move(answer));
              });
  }

  /// The response to plain HTTP on a port that expects TLS.
  HttpResponse to_https(const HttpRequest& request) {
    framing_.keep_alive = false;
    if (auto refusal = context_.access.admit(request, false).refusal) return *std::move(refusal);
    HttpResponse response = text_response(400, "This port speaks HTTPS.");
    if (request.method != "GET" && request.method != "HEAD") return response;
    response.status = 308;
    // Without the query: a token in it was sent in the clear.
    response.headers.emplace_back("Location",
                                  "https://" + std::string(request.header("host")) + request.path);
    return response;
  }

  void become_viewer(const HttpRequest& request) {
    Admission admission = context_.access.admit(request);
    if (admission.refusal) return send(*std::move(admission.refusal));
    if (context_.draining) return send(retry_later("The server is shutting down."));
    if (auto refused = upgrade_refusal(request, context_.host.sessions())) {
      return send(*std::move(refused));
    }
    ++context_.traffic.responses[101];
    stream_.next_layer().expires_never();
    start_viewer_connection(context_, std::move(stream_), request, admission.role);
  }

  void start_mjpeg(const HttpRequest& request, const std::string& session) {
    framing_.keep_alive = false;
    Admission admission = context_.access.admit(request);
    if (admission.refusal) return send(*std::move(admission.refusal));
    if (context_.draining) return send(retry_later("The server is shutting down."));
    const auto found = context_.host.sessions().find(session);
    if (!found) return send(text_response(404, found.error().message));
    const auto options = mjpeg_stream_options(request);
    if (!options) return send(error_response(options.error()));
    stream_.next_layer().expires_never();
    start_mjpeg_stream(context_, std::move(stream_), request, session, *options);
  }

  void send(HttpResponse answer) {
    writer_.write(stream_, std::move(answer), framing_,
                  [self = shared_from_this()](error_code error) { self->sent(error); });
  }

  void sent(error_code error) {
    answering_ = false;
    writer_.finish();
    if (error) return;
    if (!framing_.keep_alive || shutting_down_) return close();
    read();
  }

  void close() {
    stream_.next_layer().expires_after(closing_timeout);
    if (!stream_.is_secure()) {
      error_code ignored;
      stream_.next_layer().socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
      return discard();
    }
    async_teardown(beast::role_type::server, stream_,
                   [self = shared_from_this()](error_code) { self->stream_.next_layer().close(); });
  }

  /// Discards input until the client closes: closing a socket with unread input resets the
  /// connection, and the client may lose the response.
  void discard() {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(discarded_at_once),
                            [self = shared_from_this()](error_code error, std::size_t) {
                              if (!error) return self->discard();
                              self->stream_.next_layer().close();
                            });
  }

  ServerContext& context_;
  const ListenerKind listener_kind_;
  ClientStream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<BeastRequest::header_type> headers_before_body_;  // where trailers may follow
  ChunkExaminer examine_chunk_;  // the parser keeps a reference to it
  UploadReceiver upload_{context_};
  asio::steady_timer presence_timer_;  // runs while an answer is being made
  Framing framing_;
  ResponseWriter writer_{context_};
  RateLimit calls_;
  bool first_ = true;
  bool answering_ = false;
  bool shutting_down_ = false;
};

}  // namespace

void start_http_connection(ServerContext& context, ClientStream stream, ListenerKind kind) {
  make_connection<HttpConnection>(context, std::move(stream), kind)->start();
}

}  // namespace heliograph::net
