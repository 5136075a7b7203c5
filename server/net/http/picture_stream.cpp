#include <array>
#include <atomic>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/write.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "net/connection.hpp"
#include "net/http/beast_messages.hpp"
#include "net/websocket/reader_progress.hpp"
#include "protocol/messages/messages.hpp"
#include "session/event_log.hpp"
#include "session/viewers/viewer_link.hpp"

namespace heliograph::net {
namespace {

namespace http = beast::http;
using boost::system::error_code;

// A client that takes no data for so long is let go.
constexpr std::chrono::seconds longest_write{15};
// The picture is sent again where nothing changes for so long: proxies cut off what is silent for
// longer, often 60 s or 30 s.
constexpr std::chrono::seconds longest_silence{20};

// Browsers show a part only when the header of the next one arrives, so that header goes out with
// each picture, and cannot tell the next picture's length.
constexpr std::string_view first_part = "--frame\r\nContent-Type: image/jpeg\r\n\r\n";
constexpr std::string_view next_part = "\r\n--frame\r\nContent-Type: image/jpeg\r\n\r\n";
constexpr std::string_view last_part = "\r\n--frame--\r\n";

/// A viewer that only takes pictures. What has been written counts as acknowledged: the small send
/// buffer of its socket is all that lies between, and there is no queue.
class PictureStream : public Connection,
                      public session::ViewerLink,
                      public std::enable_shared_from_this<PictureStream> {
 public:
  PictureStream(ServerContext& context, ClientStream stream)
      : context_(context),
        stream_(std::move(stream)),
        watch_(stream_.get_executor()),
        rest_(stream_.get_executor()) {
    context_.enter(*this);
  }
  ~PictureStream() override { context_.leave(*this); }

  void start(const HttpRequest& request, const std::string& session,
             const protocol::StreamConfigure& wishes) {
    const auto joined = context_.host.sessions().enter(session, weak_from_this(), true);
    const auto sharing = context_.access.sharing_headers(request);
    if (!joined) return refuse(joined.error().message, sharing);
    viewer_ = *joined;
    ++context_.traffic.responses[200];
    headers_.version(11);
    headers_.result(http::status::ok);
    set_usual_headers(headers_, context_, sharing);
    headers_.set("X-Accel-Buffering", "no");
    headers_.keep_alive(false);
    session_ = session;
    client_ = context_.access.client_of(request);
    session::log_info({.session = session_, .viewer = viewer_, .client = client_},
                      "a viewer streams images over HTTP");
    headers_.set(http::field::content_type, "multipart/x-mixed-replace; boundary=frame");
    configure(wishes);
    writing_ = true;
    serializer_.emplace(headers_);
    read();  // before there is a time limit: what waits for the client's end must not run into it
    stream_.next_layer().expires_after(longest_write);
    http::async_write_header(stream_, *serializer_,
                             [self = shared_from_this()](error_code error, std::size_t) {
                               if (error || self->viewer_.empty()) return self->ended();
                               self->write(first_part);
                             });
    watch();
  }

  void shut_down() override { finish(); }

  void frame_ready() override {
    if (announced_.exchange(true)) return;
    asio::post(stream_.get_executor(), [self = shared_from_this()] {
      self->announced_ = false;
      self->write_next();
    });
  }

  void send(std::string, std::string_view) override {}

  void disconnect(std::string) override {
    asio::post(stream_.get_executor(), [self = shared_from_this()] { self->finish(); });
  }

 private:
  /// There is no room: the usual answer, and the end.
  void refuse(std::string_view why, const Headers& sharing) {
    ending_ = true;
    refusal_ = to_message(context_, come_back_later(why), {.sharing = sharing});
    stream_.next_layer().expires_after(longest_write);
    http::async_write(stream_, refusal_,
                      [self = shared_from_this()](error_code, std::size_t) { self->ended(); });
  }

  void configure(const protocol::StreamConfigure& wishes) {
    const auto session = context_.host.sessions().session_of_viewer(viewer_);
    if (!session) return;
    if (session->viewers().configure(viewer_, wishes)) session->viewers().start(viewer_);
  }

  /// Who vanished leaves pictures in the socket that nobody takes; they fit there, and block
  /// nothing.
  void watch() {
    watch_.expires_after(longest_write);
    watch_.async_wait([self = shared_from_this()](error_code error) {
      if (error || self->viewer_.empty()) return;
      const int socket = self->stream_.next_layer().socket().native_handle();
      const std::uint64_t before = std::exchange(self->taken_, bytes_taken(socket));
      if (self->taken_ == before && bytes_not_taken(socket) > 0) return self->ended();
      self->watch();
    });
  }

  /// The client has nothing to say; its end is noticed here.
  void read() {
    stream_.async_read_some(asio::buffer(incoming_),
                            [self = shared_from_this()](error_code error, std::size_t) {
                              if (error) return self->ended();
                              self->read();
                            });
  }

  void write(std::string_view text) {
    writing_ = true;
    stream_.next_layer().expires_after(longest_write);
    asio::async_write(
        stream_, asio::buffer(text.data(), text.size()),
        [self = shared_from_this()](error_code error, std::size_t) { self->written(error); });
  }

  void write_next() {
    if (writing_ || viewer_.empty()) return;
    if (ending_) return write(std::exchange(farewell_, {}));
    const auto session = context_.host.sessions().session_of_viewer(viewer_);
    if (!session) return;
    frame_ = session->viewers().take(viewer_);
    if (!frame_) return;
    shown_ = frame_->frame;
    write_picture();
  }

  void write_picture() {
    writing_ = true;
    rest_.cancel();
    stream_.next_layer().expires_after(longest_write);
    const std::array<asio::const_buffer, 2> parts{asio::buffer(shown_->payload),
                                                  asio::buffer(next_part)};
    asio::async_write(stream_, parts, [self = shared_from_this()](error_code error, std::size_t) {
      self->written(error);
    });
  }

  void written(error_code error) {
    writing_ = false;
    stream_.next_layer().expires_never();
    if (error || (ending_ && farewell_.empty())) return ended();
    if (const auto sent = std::exchange(frame_, std::nullopt)) acknowledge(*sent);
    write_next();
    if (!writing_ && shown_ && !viewer_.empty()) repeat_after_silence();
  }

  void repeat_after_silence() {
    rest_.expires_after(longest_silence);
    rest_.async_wait([self = shared_from_this()](error_code error) {
      if (!error && !self->writing_ && !self->viewer_.empty()) self->write_picture();
    });
  }

  void acknowledge(const stream::OutgoingFrame& sent) {
    const auto header = protocol::decode_frame_header(sent.header);
    const auto session = context_.host.sessions().session_of_viewer(viewer_);
    if (!header || !session) return;
    const auto known = session->viewers().acknowledge(viewer_, {.frame_seq = header->frame_seq});
    if (!known) finish();
  }

  /// Ends after the picture that is being written.
  void finish() {
    if (std::exchange(ending_, true)) return;
    write_next();
  }

  void ended() {
    ending_ = true;
    rest_.cancel();
    watch_.cancel();
    stream_.next_layer().close();
    if (viewer_.empty()) return;
    context_.host.sessions().leave(viewer_);
    session::log_info({.session = session_, .viewer = viewer_, .client = client_}, "a viewer left");
    viewer_.clear();
  }

  ServerContext& context_;
  ClientStream stream_;
  http::response<http::empty_body> headers_;
  std::optional<http::response_serializer<http::empty_body>> serializer_;
  asio::steady_timer watch_;
  std::uint64_t taken_ = 0;  // bytes, when it was looked last
  BeastResponse refusal_;    // instead of the pictures
  std::array<char, 512> incoming_{};
  std::string session_;
  std::string viewer_;
  std::string client_;  // address
  std::optional<stream::OutgoingFrame> frame_;
  stream::SharedFrame shown_;  // sent last
  asio::steady_timer rest_;    // runs while nothing is sent
  std::string_view farewell_ = last_part;
  bool writing_ = false;
  bool ending_ = false;
  std::atomic<bool> announced_ = false;
};

}  // namespace

protocol::Result<protocol::StreamConfigure> picture_stream_wishes(const HttpRequest& request) {
  const auto quality =
      number_parameter(request, "quality", protocol::min_quality, protocol::max_quality);
  if (!quality) return quality.error();
  const auto rate =
      number_parameter(request, "max_fps", 1, static_cast<std::uint32_t>(protocol::max_frame_rate));
  if (!rate) return rate.error();
  protocol::StreamConfigure wishes;
  wishes.quality = *quality;
  wishes.max_fps = *rate;
  return wishes;
}

void start_picture_stream(ServerContext& context, ClientStream stream, const HttpRequest& request,
                          const std::string& session, const protocol::StreamConfigure& wishes) {
  std::make_shared<PictureStream>(context, std::move(stream))->start(request, session, wishes);
}

}  // namespace heliograph::net
