#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace heliograph::net {

/// A set of addresses: "10.0.0.0/8", "192.168.1.7", "fd00::/8".
class AddressRange {
 public:
  /// @throws std::invalid_argument
  explicit AddressRange(const std::string& text);
  bool contains(std::string_view address) const;

 private:
  std::string bytes_;
  unsigned bits_;
};

/// What limits count as one client: the address itself, or the 64 bit network of an IPv6 address,
/// of which one customer can use every address.
std::string client_key(std::string_view address);

/// How many connections may be open at one time, in all and from one client. Used by one thread.
class ConnectionLimits {
 public:
  /// `unlimited` clients, which are proxies, count only in the total.
  ConnectionLimits(std::size_t in_all, std::size_t per_client, std::vector<AddressRange> unlimited);

  /// The right to be connected, released by its destructor.
  class Slot {
   public:
    const std::string& address() const { return address_; }

   private:
    friend class ConnectionLimits;
    std::string address_;
    std::shared_ptr<void> counted_;
  };
  /// Nothing if a limit is reached.
  std::optional<Slot> take(const std::string& address);

  std::size_t open() const { return counts_->in_all; }

 private:
  struct Counts {
    std::size_t in_all = 0;
    std::map<std::string, std::size_t> by_client;
  };

  const std::size_t in_all_;
  const std::size_t per_client_;
  const std::vector<AddressRange> unlimited_;
  std::shared_ptr<Counts> counts_ = std::make_shared<Counts>();
};

}  // namespace heliograph::net
