#pragma once

#include <boost/system/error_code.hpp>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

// For the sources of this folder only: it brings Boost.

namespace heliograph::net {

/// The completion handler of any asynchronous operation, behind one type. Beast's algorithms are
/// handlers themselves: with this type in between, the operations of the sockets and of TLS are
/// compiled once and not once for each algorithm.
class IoHandler {
 public:
  /// `handler` is called with the error code and, if it takes it, the number of bytes.
  template <class Handler>
  requires(!std::is_same_v<std::decay_t<Handler>, IoHandler>) IoHandler(Handler&& handler)
      : call_(std::make_unique<Call<std::decay_t<Handler>>>(std::forward<Handler>(handler))) {}

  void operator()(boost::system::error_code error, std::size_t bytes = 0) {
    const std::unique_ptr<AnyCall> call = std::move(call_);
    call->complete(error, bytes);
  }

 private:
  struct AnyCall {
    virtual ~AnyCall() = default;
    virtual void complete(boost::system::error_code error, std::size_t bytes) = 0;
  };
  template <class Handler>
  struct Call final : AnyCall {
    template <class From>
    explicit Call(From&& from) : handler(std::forward<From>(from)) {}
    void complete(boost::system::error_code error, std::size_t bytes) override {
      if constexpr (std::is_invocable_v<Handler, boost::system::error_code, std::size_t>) {
        handler(error, bytes);
      } else {
        handler(error);
      }
    }
    Handler handler;
  };

  std::unique_ptr<AnyCall> call_;
};

}  // namespace heliograph::net
