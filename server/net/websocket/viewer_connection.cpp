#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/post.hpp>
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
#include "net/websocket/presence.hpp"
#include "net/websocket/reader_progress.hpp"
#include "net/websocket/refused_calls.hpp"
#include "protocol/messages/messages.hpp"
#include "session/event_log.hpp"
#include "session/viewers/viewer_link.hpp"

namespace heliograph::net {
namespace {

namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;

// What may wait behind the message that is being written: more is only for who goes on taking it.
constexpr std::size_t patient_messages = 256;
constexpr std::size_t most_messages = 4096;
// An answer that would not fit behind what waits is replaced by an error. Large enough for a
// captured picture of the largest size.
constexpr std::size_t most_waiting_bytes = 256u << 20;
constexpr std::chrono::seconds longest_stall{2};
constexpr std::chrono::seconds watch_interval{5};

constexpr std::uint16_t session_ended = 4003;
constexpr std::uint16_t slow_consumer = 4004;
constexpr int reconnect_after_ms = 1000;
constexpr std::chrono::seconds longest_without_acknowledgement{10};

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
        patience_(socket_.get_executor()),
        watch_(socket_.get_executor()),
        stall_(socket_.get_executor()),
        calls_(calls_per_second, calls_at_once, RateLimit::Clock::now()),
        refusals_(refusals_per_second, refusals_at_once, RateLimit::Clock::now()),
        pings_(pings_per_second, pings_at_once, RateLimit::Clock::now()) {
    context_.enter(*this);
  }
  ~ViewerConnection() override { context_.leave(*this); }

  void accept(const HttpRequest& request) {
    websocket::stream_base::timeout timeouts{};
    timeouts.handshake_timeout = handshake_timeout;
    // Beast would give up a peer that is busy reading a long message; see watch.
    timeouts.idle_timeout = websocket::stream_base::none();
    timeouts.keep_alive_pings = false;
    socket_.set_option(timeouts);
    socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, std::string(protocol::protocol_name));
    }));
    socket_.read_message_max(context_.host.dispatch_limits().max_message_bytes);
    // One WebSocket frame per picture, written from where it lies.
    socket_.auto_fragment(false);
    socket_.control_callback([this](websocket::frame_type kind, beast::string_view) {
      presence_.heard(Presence::Clock::now());
      if (kind == websocket::frame_type::ping && !pings_.allow(RateLimit::Clock::now())) {
        flooded("too many pings");
      }
    });
    client_ = context_.access.client_of(request);

    handshake_.method(http::verb::get);
    handshake_.target(request.path);
    handshake_.version(11);
    for (const auto& [name, value] : request.headers) handshake_.set(name, value);
    socket_.async_accept(handshake_, [self = shared_from_this()](error_code error) {
      if (!error) self->accepted();
    });
  }

  void shut_down() override {
    close(1001, "{\"reconnect_after_ms\":" + std::to_string(reconnect_after_ms) + "}");
  }

  void frame_ready() override {
    if (announced_.exchange(true)) return;
    asio::post(socket_.get_executor(), [self = shared_from_this()] {
      self->announced_ = false;
      self->write_next();
    });
  }

  void send(std::string text, std::string_view key) override {
    asio::post(socket_.get_executor(), [self = shared_from_this(), text = std::move(text),
                                        key = std::string(key)]() mutable {
      self->enqueue(std::move(text), std::move(key));
    });
  }

  void disconnect(std::string why) override {
    asio::post(socket_.get_executor(), [self = shared_from_this(), why = std::move(why)] {
      self->farewell_ = why;
      self->write_next();
    });
  }

 private:
  struct Message {
    std::string text;
    std::string key;
  };

  void accepted() {
    const auto joined = context_.host.sessions().enter(session_, weak_from_this(), view_only_);
    if (!joined) {
      close(websocket::close_code::try_again_later, joined.error().message);
      return read();
    }
    viewer_ = *joined;
    session::log_info({.session = session_, .viewer = viewer_, .client = client_},
                      view_only_ ? "a viewer connected, to watch only" : "a viewer connected");
    if (context_.ending) shut_down();
    presence_.heard(Presence::Clock::now());
    watch();
    read();
  }

  void read() {
    socket_.async_read(incoming_, [self = shared_from_this()](error_code error, std::size_t) {
      self->received(error);
    });
  }

  void received(error_code error) {
    if (error) return ended(error);
    presence_.heard(Presence::Clock::now());
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
      std::string refusal = refuse_calls(message, too_many_messages());
      if (!refusal.empty()) enqueue(std::move(refusal), {});
      if (!refusals_.allow(RateLimit::Clock::now())) flooded("too many messages");
    }
    read();
  }

  void call(std::string message) {
    const auto text = std::make_shared<const std::string>(std::move(message));
    context_.host.dispatcher().handle(*text, {.viewer = viewer_, .view_only = view_only_},
                                      [text, weak = weak_from_this()](std::string answer) {
                                        const auto self = weak.lock();
                                        if (!self || answer.empty()) return;
                                        if (answer.size() <= small_answer)
                                          return self->send(std::move(answer), {});
                                        asio::post(
                                            self->socket_.get_executor(),
                                            [self, text, answer = std::move(answer)]() mutable {
                                              self->enqueue_large(std::move(answer), *text);
                                            });
                                      });
  }

  void enqueue_large(std::string answer, std::string_view message) {
    if (waiting_bytes_ + answer.size() > most_waiting_bytes || !outgoing_.has_room(answer.size())) {
      answer = refuse_calls(message, answer_too_large("256 MiB"));
    }
    enqueue(std::move(answer), {});
  }

  /// Lets go of somebody who does not heed the limits. From within the control callback too, where
  /// the close frame must wait until Beast is done with what it reads.
  void flooded(const char* what) {
    if (closing_ || std::exchange(flooded_, true)) return;
    session::log_warning({.viewer = viewer_, .client = client_}, what);
    asio::post(socket_.get_executor(), [self = shared_from_this(), what] {
      self->close(websocket::close_code::policy_error, what);
    });
  }

  void enqueue(std::string text, std::string key) {
    if (closing_) return;
    const auto same = std::find_if(waiting_.begin(), waiting_.end(), [&](const Message& message) {
      return !key.empty() && message.key == key;
    });
    if (same != waiting_.end()) {
      waiting_bytes_ += text.size();
      waiting_bytes_ -= same->text.size();
      same->text = std::move(text);
      return;
    }
    waiting_bytes_ += text.size();
    waiting_.push_back({.text = std::move(text), .key = std::move(key)});
    if (waiting_.size() > most_messages) return let_go_slow();
    if (waiting_.size() > patient_messages) expect_progress();
    outgoing_.hold(waiting_bytes_ + text_in_flight_.size());
    write_next();
  }

  /// Lets a viewer go that lets messages pile up while it takes none of what is being sent.
  void expect_progress() {
    if (std::exchange(stall_runs_, true)) return;
    stall_.expires_after(longest_stall);
    stall_.async_wait([self = shared_from_this(), before = taken()](error_code error) {
      self->stall_runs_ = false;
      if (error || self->closing_ || self->waiting_.size() <= patient_messages) return;
      if (self->taken() == before) return self->let_go_slow();
      self->expect_progress();
    });
  }

  void let_go_slow() {
    waiting_.clear();
    ++context_.traffic.viewers_let_go;
    close(slow_consumer, "messages are not being read");
  }

  /// Bytes that the viewer's system has taken so far.
  std::uint64_t taken() {
    return bytes_taken(beast::get_lowest_layer(socket_).socket().native_handle());
  }

  /// Looks now and then whether the viewer is still there.
  void watch() {
    watch_.expires_after(watch_interval);
    watch_.async_wait([self = shared_from_this()](error_code error) {
      if (error || self->closing_) return;
      const std::uint64_t write = self->writing_ ? self->writes_ : 0;
      const auto verdict = self->presence_.look(Presence::Clock::now(), write, self->taken());
      if (verdict == Presence::Verdict::gone) return self->ended(beast::error::timeout);
      if (verdict == Presence::Verdict::silent && !self->pinging_) self->ping();
      self->watch();
    });
  }

  void ping() {
    pinging_ = true;
    socket_.async_ping({}, [self = shared_from_this()](error_code) { self->pinging_ = false; });
  }

  void write_next() {
    if (writing_ || closing_ || viewer_.empty()) return;
    const auto done = [self = shared_from_this()](error_code error, std::size_t) {
      self->written(error);
    };
    if (!waiting_.empty()) {
      writing_ = true;
      ++writes_;
      text_in_flight_ = std::move(waiting_.front().text);
      waiting_.pop_front();
      waiting_bytes_ -= text_in_flight_.size();
      socket_.text(true);
      return socket_.async_write(asio::buffer(text_in_flight_), done);
    }
    if (farewell_) return close(session_ended, *farewell_);
    const auto session = context_.host.sessions().session_of_viewer(viewer_);
    if (!session) return;
    frame_in_flight_ = session->viewers().take(viewer_);
    if (!frame_in_flight_) return;
    writing_ = true;
    ++writes_;
    const std::array<asio::const_buffer, 2> parts{asio::buffer(frame_in_flight_->header),
                                                  asio::buffer(frame_in_flight_->frame->payload)};
    socket_.binary(true);
    socket_.async_write(parts, done);
    if (!std::exchange(patience_runs_, true)) {
      expect_acknowledgement(std::chrono::steady_clock::now());
    }
  }

  /// Lets a viewer go that takes frames but does not acknowledge them.
  void expect_acknowledgement(std::chrono::steady_clock::time_point since) {
    patience_.expires_at(since + longest_without_acknowledgement);
    patience_.async_wait([self = shared_from_this()](error_code error) {
      if (error || self->closing_ || self->viewer_.empty()) return;
      const auto session = self->context_.host.sessions().session_of_viewer(self->viewer_);
      const auto waits =
          session ? session->viewers().unacknowledged_since(self->viewer_) : std::nullopt;
      self->patience_runs_ = waits.has_value();
      if (!waits) return;
      if (std::chrono::steady_clock::now() < *waits + longest_without_acknowledgement) {
        return self->expect_acknowledgement(*waits);
      }
      self->close(slow_consumer, "frames are not being acknowledged");
    });
  }

  void written(error_code error) {
    writing_ = false;
    text_in_flight_ = {};
    outgoing_.hold(waiting_bytes_);
    frame_in_flight_.reset();
    if (!error) write_next();
  }

  void close(std::uint16_t code, const std::string& reason) {
    if (std::exchange(closing_, true)) return;
    websocket::close_reason close_reason(code);
    // What fits into a control frame, RFC 6455 section 5.5.
    close_reason.reason.assign(reason.data(), std::min<std::size_t>(reason.size(), 123));
    socket_.async_close(close_reason,
                        [self = shared_from_this()](error_code error) { self->ended(error); });
    // A peer that does not answer, or a write that never ends, must not keep the socket open.
    close_deadline_.expires_after(closing_timeout);
    close_deadline_.async_wait([self = shared_from_this()](error_code error) {
      if (!error) self->ended(error);
    });
  }

  void ended(error_code error) {
    closing_ = true;
    close_deadline_.cancel();
    patience_.cancel();
    watch_.cancel();
    stall_.cancel();
    waiting_.clear();
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
    if (viewer_.empty()) return;
    // It may have joined another since it came.
    const auto session = context_.host.sessions().session_of_viewer(viewer_);
    context_.host.sessions().leave(viewer_);
    session::log_info(
        {.session = session ? session->name() : session_, .viewer = viewer_, .client = client_},
        "a viewer left: " + error.message());
    viewer_.clear();
  }

  ServerContext& context_;
  const std::string session_;  // where it came in
  const bool view_only_;
  websocket::stream<ClientStream> socket_;
  http::request<http::empty_body> handshake_;
  asio::steady_timer close_deadline_;
  asio::steady_timer patience_;  // runs while a frame is on its way
  bool patience_runs_ = false;
  asio::steady_timer watch_;
  asio::steady_timer stall_;  // runs while too much waits
  bool stall_runs_ = false;
  Presence presence_{idle_timeout, slowest_reader, watch_interval, Presence::Clock::now()};
  std::uint64_t writes_ = 0;  // messages and frames so far
  bool pinging_ = false;
  RateLimit calls_;
  RateLimit refusals_;
  RateLimit pings_;
  bool flooded_ = false;
  std::string client_;  // address
  beast::flat_buffer incoming_;
  std::string viewer_;
  std::deque<Message> waiting_;
  std::size_t waiting_bytes_ = 0;
  OutgoingBytes outgoing_{context_.outgoing_bytes};
  std::string text_in_flight_;
  std::optional<stream::OutgoingFrame> frame_in_flight_;
  std::optional<std::string> farewell_;  // why to close once everything is sent
  bool writing_ = false;
  bool closing_ = false;
  std::atomic<bool> announced_ = false;
};

}  // namespace

void start_viewer_connection(ServerContext& context, ClientStream stream,
                             const HttpRequest& request, Role role) {
  std::make_shared<ViewerConnection>(context, std::move(stream), session_of(request), role)
      ->accept(request);
}

}  // namespace heliograph::net
