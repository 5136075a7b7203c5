#include <array>
#include <atomic>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/write.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "net/connection.hpp"
#include "net/http/beast_messages.hpp"
#include "net/http/image_request.hpp"
#include "net/tcp_progress.hpp"
#include "protocol/messages/messages.hpp"
#include "session/event_log.hpp"
#include "session/viewers/viewer_link.hpp"

namespace heliograph::net {
namespace {

namespace http = beast::http;
using boost::system::error_code;

// A client that acknowledges no data for this long is disconnected.
constexpr std::chrono::seconds write_timeout{15};
// The frame is repeated if nothing changes for this long: proxies close connections that are idle
// for longer, often 60 s or 30 s.
constexpr std::chrono::seconds repeat_interval{20};

// Browsers show a part only when the header of the next one arrives, so that header follows each
// frame, and cannot contain the length of the next one.
constexpr std::string_view first_part = "--frame\r\nContent-Type: image/jpeg\r\n\r\n";
constexpr std::string_view next_part = "\r\n--frame\r\nContent-Type: image/jpeg\r\n\r\n";
constexpr std::string_view last_part = "\r\n--frame--\r\n";

/// A viewer that only receives JPEG frames. A written frame counts as acknowledged: only the small
/// send buffer of its socket lies between, and there is no queue.
class MjpegStream : public Connection,
                    public session::ViewerLink,
                    public std::enable_shared_from_this<MjpegStream> {
 public:
  MjpegStream(ServerContext& context, ClientStream stream)
      : context_(context),
        stream_(std::move(stream)),
        progress_timer_(stream_.get_executor()),
        repeat_timer_(stream_.get_executor()) {
    context_.enter(*this);
  }
  ~MjpegStream() override { context_.leave(*this); }

  void start(const HttpRequest& request, const std::string& session,
             const protocol::StreamConfigure& options) {
    const auto joined = context_.host.sessions().enter(session, weak_from_this(), true);
    const auto cors = context_.access.cors_headers(request);
    if (!joined) return refuse(joined.error().message, cors);
    viewer_ = *joined;
    ++context_.traffic.responses[200];
    headers_.version(11);
    headers_.result(http::status::ok);
    set_usual_headers(headers_, context_, cors);
    headers_.set("X-Accel-Buffering", "no");
    headers_.keep_alive(false);
    session_ = session;
    client_ = context_.access.client_of(request);
    session::log_info({.session = session_, .viewer = viewer_, .client = client_},
                      "a viewer streams images over HTTP");
    headers_.set(http::field::content_type, "multipart/x-mixed-replace; boundary=frame");
    configure(options);
    writing_ = true;
    serializer_.emplace(headers_);
    read();  // before a timeout is set: the read that waits for the client's end has none
    stream_.next_layer().expires_after(write_timeout);
    http::async_write_header(stream_, *serializer_,
                             IoHandler([self = shared_from_this()](error_code error) {
                               if (error || self->viewer_.empty()) return self->ended();
                               self->write(first_part);
                             }));
    check_progress();
  }

  void shut_down() override { finish(); }

  void frame_ready() override {
    if (announced_.exchange(true)) return;
    run_later(stream_.get_executor(), [self = shared_from_this()] {
      self->announced_ = false;
      self->write_next();
    });
  }

  void send(std::string, std::string_view) override {}

  void disconnect(std::string) override {
    run_later(stream_.get_executor(), [self = shared_from_this()] { self->finish(); });
  }

 private:
  /// The session has no room for the viewer: sends 503 and closes.
  void refuse(std::string_view why, const Headers& cors) {
    ending_ = true;
    headers_ = to_message(context_, retry_later(why), {.cors = cors});
    stream_.next_layer().expires_after(write_timeout);
    serializer_.emplace(headers_);
    http::async_write(stream_, *serializer_,
                      IoHandler([self = shared_from_this()](error_code) { self->ended(); }));
  }

  void configure(const protocol::StreamConfigure& options) {
    const auto session = context_.host.sessions().session_of_viewer(viewer_);
    if (!session) return;
    if (session->viewers().configure(viewer_, options)) session->viewers().start(viewer_);
  }

  /// Disconnects a client that vanished. Writes do not block then, because frames of a static view
  /// fit into the send buffer.
  void check_progress() {
    progress_timer_.expires_after(write_timeout);
    on_expiry(progress_timer_, [self = shared_from_this()](error_code error) {
      if (error || self->viewer_.empty()) return;
      const int socket = self->stream_.next_layer().socket().native_handle();
      const std::uint64_t before = std::exchange(self->acknowledged_, bytes_acknowledged(socket));
      if (self->acknowledged_ == before && bytes_unacknowledged(socket) > 0) return self->ended();
      self->check_progress();
    });
  }

  /// The client sends nothing; the end of its connection completes this.
  void read() {
    stream_.async_read_some(asio::buffer(incoming_),
                            [self = shared_from_this()](error_code error, std::size_t) {
                              if (error) return self->ended();
                              self->read();
                            });
  }

  void write(std::string_view text) {
    writing_ = true;
    stream_.next_layer().expires_after(write_timeout);
    write_all(stream_, WriteBuffers(asio::buffer(text.data(), text.size())),
              [self = shared_from_this()](error_code error) { self->written(error); });
  }

  void write_next() {
    if (writing_ || viewer_.empty()) return;
    if (ending_) return write(std::exchange(end_part_, {}));
    const auto session = context_.host.sessions().session_of_viewer(viewer_);
    if (!session) return;
    frame_ = session->viewers().take(viewer_);
    if (!frame_) return;
    last_frame_ = frame_->frame;
    write_frame();
  }

  void write_frame() {
    writing_ = true;
    repeat_timer_.cancel();
    stream_.next_layer().expires_after(write_timeout);
    const std::array<asio::const_buffer, 2> parts{asio::buffer(last_frame_->payload),
                                                  asio::buffer(next_part)};
    write_all(stream_, WriteBuffers(parts),
              [self = shared_from_this()](error_code error) { self->written(error); });
  }

  void written(error_code error) {
    writing_ = false;
    stream_.next_layer().expires_never();
    if (error || (ending_ && end_part_.empty())) return ended();
    if (const auto sent = std::exchange(frame_, std::nullopt)) acknowledge(*sent);
    write_next();
    if (!writing_ && last_frame_ && !viewer_.empty()) repeat_after_silence();
  }

  void repeat_after_silence() {
    repeat_timer_.expires_after(repeat_interval);
    on_expiry(repeat_timer_, [self = shared_from_this()](error_code error) {
      if (!error && !self->writing_ && !self->viewer_.empty()) self->write_frame();
    });
  }

  void acknowledge(const stream::OutgoingFrame& sent) {
    const auto header = protocol::decode_frame_header(sent.header);
    const auto session = context_.host.sessions().session_of_viewer(viewer_);
    if (!header || !session) return;
    const auto known = session->viewers().acknowledge(viewer_, {.frame_seq = header->frame_seq});
    if (!known) finish();
  }

  /// Ends after the frame that is being written.
  void finish() {
    if (std::exchange(ending_, true)) return;
    write_next();
  }

  void ended() {
    ending_ = true;
    repeat_timer_.cancel();
    progress_timer_.cancel();
    stream_.next_layer().close();
    if (viewer_.empty()) return;
    context_.host.sessions().leave(viewer_);
    session::log_info({.session = session_, .viewer = viewer_, .client = client_}, "a viewer left");
    viewer_.clear();
  }

  ServerContext& context_;
  ClientStream stream_;
  BeastResponse headers_;  // or the whole response, if the stream is rejected
  std::optional<http::response_serializer<http::string_body>> serializer_;
  asio::steady_timer progress_timer_;
  std::uint64_t acknowledged_ = 0;  // bytes, at the last check
  std::array<char, 512> incoming_{};
  std::string session_;
  std::string viewer_;
  std::string client_;  // address
  std::optional<stream::OutgoingFrame> frame_;
  stream::SharedFrame last_frame_;   // sent last
  asio::steady_timer repeat_timer_;  // runs while nothing is sent
  std::string_view end_part_ = last_part;
  bool writing_ = false;
  bool ending_ = false;
  std::atomic<bool> announced_ = false;
};

}  // namespace

protocol::Result<protocol::StreamConfigure> mjpeg_stream_options(const HttpRequest& request) {
  const auto known = check_parameters(request, {"quality", "max_fps"});
  if (!known) return known.error();
  const auto quality =
      number_parameter(request, "quality", protocol::min_quality, protocol::max_quality);
  if (!quality) return quality.error();
  const auto rate =
      number_parameter(request, "max_fps", 1, static_cast<std::uint32_t>(protocol::max_frame_rate));
  if (!rate) return rate.error();
  protocol::StreamConfigure options;
  options.quality = *quality;
  options.max_fps = *rate;
  return options;
}

void start_mjpeg_stream(ServerContext& context, ClientStream stream, const HttpRequest& request,
                        const std::string& session, const protocol::StreamConfigure& options) {
  make_connection<MjpegStream>(context, std::move(stream))->start(request, session, options);
}

}  // namespace heliograph::net
