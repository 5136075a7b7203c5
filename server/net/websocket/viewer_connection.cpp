#include <algorithm>
#include <array>
#include <atomic>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "net/connection.hpp"
#include "net/security/rate_limit.hpp"
#include "net/tcp_progress.hpp"
#include "net/websocket/liveness.hpp"
#include "net/websocket/rejected_calls.hpp"
#include "protocol/messages/messages.hpp"
#include "session/event_log.hpp"
#include "session/viewers/viewer_link.hpp"

namespace heliograph::net {
namespace {

namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;

// Messages queued behind the one being written. Above the first limit the client must keep reading.
constexpr std::size_t unchecked_pending_messages = 256;
constexpr std::size_t max_pending_messages = 4096;
// A response that would exceed this is replaced by an error. Large enough for a captured image of
// the largest size.
constexpr std::size_t max_pending_bytes = 256u << 20;
constexpr std::chrono::seconds stall_timeout{2};
constexpr std::chrono::seconds liveness_interval{5};

constexpr std::uint16_t last_close_code = 4999;  // RFC 6455 section 7.4.2
constexpr std::uint16_t session_ended = 4003;
constexpr std::uint16_t slow_consumer = 4004;
constexpr int reconnect_after_ms = 1000;
constexpr std::chrono::seconds ack_timeout{10};

class ViewerConnection : public Connection,
                         public session::ViewerLink,
                         public std::enable_shared_from_this<ViewerConnection> {
 public:
  ViewerConnection(ServerContext& context, ClientStream stream, std::string session, Role role)
      : context_(context),
        session_(std::move(session)),
        view_only_(role == Role::view),
        socket_(std::move(stream)),
        close_deadline_(socket_.get_executor()),
        ack_timer_(socket_.get_executor()),
        liveness_timer_(socket_.get_executor()),
        stall_timer_(socket_.get_executor()),
        calls_(calls_per_second, calls_at_once, RateLimit::Clock::now()),
        rejections_(rejections_per_second, rejections_at_once, RateLimit::Clock::now()),
        pings_(pings_per_second, pings_at_once, RateLimit::Clock::now()) {
    context_.enter(*this);
  }
  ~ViewerConnection() override { context_.leave(*this); }

  void accept(const HttpRequest& request) {
    websocket::stream_base::timeout timeouts{};
    timeouts.handshake_timeout = handshake_timeout;
    // Beast would disconnect a peer that is busy reading a long message; see check_liveness.
    timeouts.idle_timeout = websocket::stream_base::none();
    timeouts.keep_alive_pings = false;
    socket_.set_option(timeouts);
    socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, std::string(protocol::protocol_name));
    }));
    socket_.read_message_max(context_.host.dispatch_limits().max_message_bytes);
    // One WebSocket frame per encoded frame, written without a copy.
    socket_.auto_fragment(false);
    socket_.control_callback([this](websocket::frame_type kind, beast::string_view) {
      liveness_.received(Liveness::Clock::now());
      // Beast would repeat it; it refuses all other codes that may not be sent.
      if (kind == websocket::frame_type::close && socket_.reason().code > last_close_code) {
        close(websocket::close_code::protocol_error, "the close code is out of range");
      }
      if (kind == websocket::frame_type::ping && !pings_.allow(RateLimit::Clock::now())) {
        disconnect_rate_limited("too many pings");
      }
    });
    client_ = context_.access.client_of(request);

    handshake_.method(http::verb::get);
    handshake_.target(request.path);
    handshake_.version(11);
    for (const auto& [name, value] : request.headers) handshake_.set(name, value);
    socket_.async_accept(handshake_, IoHandler([self = shared_from_this()](error_code error) {
                           if (!error) self->or_end([&] { self->accepted(); });
                         }));
  }

  void shut_down() override {
    close(1001, "{\"reconnect_after_ms\":" + std::to_string(reconnect_after_ms) + "}");
  }

  void frame_ready() override {
    if (announced_.exchange(true)) return;
    try {
      run_later(socket_.get_executor(), [self = shared_from_this()] {
        self->announced_ = false;
        self->or_end([&] { self->write_next(); });
      });
    } catch (const std::bad_alloc&) {
      announced_ = false;
      throw;
    }
  }

  void send(std::string text, std::string_view key) override {
    run_later(socket_.get_executor(), [self = shared_from_this(), text = std::move(text),
                                       key = std::string(key)]() mutable {
      self->or_end([&] { self->enqueue(std::move(text), std::move(key)); });
    });
  }

  void disconnect(std::string why) override {
    run_later(socket_.get_executor(), [self = shared_from_this(), why = std::move(why)] {
      self->session_end_reason_ = why;
      self->or_end([&] { self->write_next(); });
    });
  }

 private:
  struct Message {
    std::string text;
    std::string key;
  };

  /// A viewer that there is no memory for is disconnected; it may come again.
  template <class Work>
  void or_end(const Work& work) {
    try {
      work();
    } catch (const std::bad_alloc&) {
      ended(make_error_code(boost::system::errc::not_enough_memory));
    }
  }

  void accepted() {
    const auto joined = context_.host.sessions().enter(session_, weak_from_this(), view_only_);
    if (!joined) {
      close(websocket::close_code::try_again_later, joined.error().message);
      return read();
    }
    viewer_ = *joined;
    session::log_info({.session = session_, .viewer = viewer_, .client = client_},
                      view_only_ ? "a viewer connected, read-only" : "a viewer connected");
    if (context_.ending) shut_down();
    liveness_.received(Liveness::Clock::now());
    check_liveness();
    read();
  }

  void read() {
    socket_.async_read(incoming_, IoHandler([self = shared_from_this()](error_code error) {
                         self->or_end([&] { self->received(error); });
                       }));
  }

  void received(error_code error) {
    if (error) return ended(error);
    liveness_.received(Liveness::Clock::now());
    const bool text = socket_.got_text();
    std::string message = beast::buffers_to_string(incoming_.data());
    incoming_.consume(incoming_.size());
    if (closing_) return read();
    if (!text) {
      close(websocket::close_code::unknown_data, "messages to the server are text");
      return read();
    }
    ++context_.traffic.calls;
    if (calls_.allow(RateLimit::Clock::now())) {
      call(std::move(message));
    } else {
      ++context_.traffic.calls_refused;
      std::string refusal = reject_calls(message, too_many_messages());
      if (!refusal.empty()) enqueue(std::move(refusal), {});
      if (!rejections_.allow(RateLimit::Clock::now())) disconnect_rate_limited("too many messages");
    }
    read();
  }

  void call(std::string message) {
    const auto text = std::make_shared<const std::string>(std::move(message));
    const auto pending =
        std::make_shared<protocol::PendingAnswer>(max_pending_bytes, context_.answer_memory);
    const protocol::CallContext caller{
        .viewer = viewer_, .view_only = view_only_, .answer = pending};
    context_.host.dispatcher().handle(
        *text, caller, [text, pending, weak = weak_from_this()](std::string answer) {
          const auto self = weak.lock();
          if (!self || answer.empty()) return;
          try {
            self->send_answer(std::move(answer), text, pending);
          } catch (const std::bad_alloc&) {
            self->answer_lost_ = true;  // check_liveness() ends the connection
            throw;
          }
        });
  }

  void send_answer(std::string answer, const std::shared_ptr<const std::string>& message,
                   const std::shared_ptr<protocol::PendingAnswer>& pending) {
    if (answer.size() <= small_answer) return send(std::move(answer), {});
    run_later(socket_.get_executor(),
              [self = shared_from_this(), message, pending, answer = std::move(answer)]() mutable {
                self->or_end([&] { self->enqueue_large(std::move(answer), *message); });
              });
  }

  void enqueue_large(std::string answer, std::string_view message) {
    if (pending_bytes_ + answer.size() > max_pending_bytes || !outgoing_.has_room(answer.size())) {
      answer = reject_calls(message, answer_too_large("256 MiB"));
    }
    enqueue(std::move(answer), {});
  }

  /// Disconnects a client that exceeds a rate limit. Also called from within the control callback,
  /// where the close frame must wait until Beast has finished reading.
  void disconnect_rate_limited(const char* what) {
    if (closing_ || std::exchange(rate_limited_, true)) return;
    session::log_warning({.viewer = viewer_, .client = client_}, what);
    run_later(socket_.get_executor(), [self = shared_from_this(), what] {
      self->close(websocket::close_code::policy_error, what);
    });
  }

  void enqueue(std::string text, std::string key) {
    if (closing_) return;
    const auto same = std::find_if(pending_.begin(), pending_.end(), [&](const Message& message) {
      return !key.empty() && message.key == key;
    });
    if (same != pending_.end()) {
      pending_bytes_ += text.size();
      pending_bytes_ -= same->text.size();
      same->text = std::move(text);
      return;
    }
    pending_bytes_ += text.size();
    pending_.push_back({.text = std::move(text), .key = std::move(key)});
    if (pending_.size() > max_pending_messages) return disconnect_slow_consumer();
    if (pending_.size() > unchecked_pending_messages) check_progress();
    outgoing_.hold(pending_bytes_ + text_in_flight_.size());
    write_next();
  }

  /// Disconnects a viewer whose queue is long and whose system acknowledges no bytes.
  void check_progress() {
    if (std::exchange(stall_runs_, true)) return;
    stall_timer_.expires_after(stall_timeout);
    on_expiry(stall_timer_,
              [self = shared_from_this(), before = acknowledged_bytes()](error_code error) {
                self->stall_runs_ = false;
                if (error || self->closing_ || self->pending_.size() <= unchecked_pending_messages)
                  return;
                if (self->acknowledged_bytes() == before) return self->disconnect_slow_consumer();
                self->check_progress();
              });
  }

  void disconnect_slow_consumer() {
    pending_.clear();
    ++context_.traffic.slow_viewers_disconnected;
    close(slow_consumer, "messages are not being read");
  }

  /// Bytes that the viewer's system has acknowledged so far.
  std::uint64_t acknowledged_bytes() {
    return bytes_acknowledged(beast::get_lowest_layer(socket_).socket().native_handle());
  }

  /// Checks periodically whether the viewer is still connected.
  void check_liveness() {
    liveness_timer_.expires_after(liveness_interval);
    on_expiry(liveness_timer_, [self = shared_from_this()](error_code error) {
      if (error || self->closing_) return;
      if (self->answer_lost_) {
        return self->ended(make_error_code(boost::system::errc::not_enough_memory));
      }
      const std::uint64_t write = self->writing_ ? self->writes_ : 0;
      const auto verdict =
          self->liveness_.check(Liveness::Clock::now(), write, self->acknowledged_bytes());
      if (verdict == Liveness::Verdict::lost) return self->ended(beast::error::timeout);
      self->or_end([&] {
        if (verdict == Liveness::Verdict::silent && !self->pinging_) self->ping();
        self->check_liveness();
      });
    });
  }

  void ping() {
    pinging_ = true;
    socket_.async_ping(
        {}, IoHandler([self = shared_from_this()](error_code) { self->pinging_ = false; }));
  }

  void write(asio::const_buffer first, asio::const_buffer second) {
    socket_.async_write(std::array{first, second},
                        IoHandler([self = shared_from_this()](error_code error) {
                          self->or_end([&] { self->written(error); });
                        }));
  }

  void write_next() {
    if (writing_ || closing_ || viewer_.empty()) return;
    if (!pending_.empty()) {
      writing_ = true;
      ++writes_;
      text_in_flight_ = std::move(pending_.front().text);
      pending_.pop_front();
      pending_bytes_ -= text_in_flight_.size();
      socket_.text(true);
      return write(asio::buffer(text_in_flight_), {});
    }
    if (session_end_reason_) return close(session_ended, *session_end_reason_);
    const auto session = context_.host.sessions().session_of_viewer(viewer_);
    if (!session) return;
    frame_in_flight_ = session->viewers().take(viewer_);
    if (!frame_in_flight_) return;
    writing_ = true;
    ++writes_;
    socket_.binary(true);
    write(asio::buffer(frame_in_flight_->header), asio::buffer(frame_in_flight_->frame->payload));
    if (!std::exchange(ack_timeout_runs_, true)) {
      check_acknowledgement(std::chrono::steady_clock::now());
    }
  }

  /// Disconnects a viewer that reads frames but does not acknowledge them.
  void check_acknowledgement(std::chrono::steady_clock::time_point since) {
    ack_timer_.expires_at(since + ack_timeout);
    on_expiry(ack_timer_, [self = shared_from_this()](error_code error) {
      if (error || self->closing_ || self->viewer_.empty()) return;
      const auto session = self->context_.host.sessions().session_of_viewer(self->viewer_);
      const auto waits =
          session ? session->viewers().unacknowledged_since(self->viewer_) : std::nullopt;
      self->ack_timeout_runs_ = waits.has_value();
      if (!waits) return;
      if (std::chrono::steady_clock::now() < *waits + ack_timeout) {
        return self->check_acknowledgement(*waits);
      }
      self->close(slow_consumer, "frames are not being acknowledged");
    });
  }

  void written(error_code error) {
    writing_ = false;
    text_in_flight_ = {};
    outgoing_.hold(pending_bytes_);
    frame_in_flight_.reset();
    if (!error) return write_next();
    // Nothing more can be sent, but a peer that waits for an answer sends nothing that would fail
    // the read. What was canceled ends with the operation that knows why.
    if (error != asio::error::operation_aborted) ended(error);
  }

  void close(std::uint16_t code, const std::string& reason) {
    if (std::exchange(closing_, true)) return;
    websocket::close_reason close_reason(code);
    // What fits into a control frame, RFC 6455 section 5.5.
    close_reason.reason.assign(reason.data(), std::min<std::size_t>(reason.size(), 123));
    socket_.async_close(close_reason, IoHandler([self = shared_from_this()](error_code error) {
                          self->ended(error);
                        }));
    // A peer that does not answer, or a write that never completes, must not keep the socket open.
    close_deadline_.expires_after(closing_timeout);
    on_expiry(close_deadline_, [self = shared_from_this()](error_code error) {
      if (!error) self->ended(error);
    });
  }

  void ended(error_code error) {
    closing_ = true;
    close_deadline_.cancel();
    ack_timer_.cancel();
    liveness_timer_.cancel();
    stall_timer_.cancel();
    pending_.clear();
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
    if (viewer_.empty()) return;
    // It may have joined another session since.
    const auto session = context_.host.sessions().session_of_viewer(viewer_);
    context_.host.sessions().leave(viewer_);
    session::log_info(
        {.session = session ? session->name() : session_, .viewer = viewer_, .client = client_},
        "a viewer left: " + error.message());
    viewer_.clear();
  }

  ServerContext& context_;
  const std::string session_;  // that the request named
  const bool view_only_;
  websocket::stream<ClientStream> socket_;
  http::request<http::empty_body> handshake_;
  asio::steady_timer close_deadline_;
  asio::steady_timer ack_timer_;  // runs while a frame is in flight
  bool ack_timeout_runs_ = false;
  asio::steady_timer liveness_timer_;
  asio::steady_timer stall_timer_;  // runs while too many messages are pending
  bool stall_runs_ = false;
  Liveness liveness_{idle_timeout, min_bytes_per_second, liveness_interval, Liveness::Clock::now()};
  std::uint64_t writes_ = 0;  // messages and frames so far
  bool pinging_ = false;
  RateLimit calls_;
  RateLimit rejections_;
  RateLimit pings_;
  bool rate_limited_ = false;
  std::string client_;  // address
  beast::flat_buffer incoming_;
  std::string viewer_;
  std::deque<Message> pending_;
  std::size_t pending_bytes_ = 0;
  OutgoingBytes outgoing_{context_.outgoing_bytes};
  std::string text_in_flight_;
  std::optional<stream::OutgoingFrame> frame_in_flight_;
  std::optional<std::string> session_end_reason_;  // set: close with it once everything is sent
  bool writing_ = false;
  bool closing_ = false;
  std::atomic<bool> announced_ = false;
  std::atomic<bool> answer_lost_ = false;  // there was no memory to send it
};

}  // namespace

void start_viewer_connection(ServerContext& context, ClientStream stream,
                             const HttpRequest& request, Role role) {
  make_connection<ViewerConnection>(context, std::move(stream), session_of(request), role)
      ->accept(request);
}

}  // namespace heliograph::net
