#include "net/security/connection_limits.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

namespace heliograph::net {
namespace {

/// 4 or 16 bytes; those of an IPv4 address also where it is written as IPv6. Empty for names.
std::string address_bytes(std::string_view address) {
  const std::string text(address.substr(0, address.find('%')));
  std::array<char, sizeof(in6_addr)> bytes{};
  if (inet_pton(AF_INET, text.c_str(), bytes.data()) == 1) return {bytes.data(), 4};
  if (inet_pton(AF_INET6, text.c_str(), bytes.data()) != 1) return {};
  constexpr std::string_view mapped("\0\0\0\0\0\0\0\0\0\0\xff\xff", 12);
  const std::string_view all(bytes.data(), bytes.size());
  return std::string(all.starts_with(mapped) ? all.substr(mapped.size()) : all);
}

bool same_bits(std::string_view a, std::string_view b, unsigned bits) {
  const std::size_t whole = bits / 8;
  if (a.substr(0, whole) != b.substr(0, whole)) return false;
  const unsigned rest = bits % 8;
  return rest == 0 || static_cast<unsigned char>(a[whole] ^ b[whole]) >> (8 - rest) == 0;
}

}  // namespace

AddressRange::AddressRange(const std::string& text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  bytes_ = address_bytes(text.substr(0, slash));
  const auto longest = static_cast<unsigned>(8 * bytes_.size());
  bits_ = longest;
  bool valid = !bytes_.empty();
  if (slash < text.size()) {
    const char* const begin = text.data() + slash + 1;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(begin, end, bits_);
    valid = valid && parsed.ec == std::errc() && parsed.ptr == end && bits_ <= longest;
  }
  if (!valid) {
    throw std::invalid_argument(
        "\"" + text + "\" is not an address such as 10.1.2.3 or a range such as 10.0.0.0/8");
  }
}

bool AddressRange::contains(std::string_view address) const {
  const std::string bytes = address_bytes(address);
  return bytes.size() == bytes_.size() && same_bits(bytes, bytes_, bits_);
}

std::string client_key(std::string_view address) {
  const std::string bytes = address_bytes(address);
  if (bytes.size() != sizeof(in6_addr)) return std::string(address);
  return bytes.substr(0, 8);
}

ConnectionLimits::ConnectionLimits(std::size_t in_all, std::size_t per_client,
                                   std::vector<AddressRange> unlimited)
    : in_all_(in_all), per_client_(per_client), unlimited_(std::move(unlimited)) {}

std::optional<ConnectionLimits::Slot> ConnectionLimits::take(const std::string& address) {
  const bool counted =
      std::none_of(unlimited_.begin(), unlimited_.end(),
                   [&](const AddressRange& range) { return range.contains(address); });
  const std::string client = counted ? client_key(address) : std::string();
  const auto found = counts_->by_client.find(client);
  const bool client_full =
      counted && found != counts_->by_client.end() && found->second >= per_client_;
  if (counts_->in_all >= in_all_ || client_full) return std::nullopt;
  ++counts_->in_all;
  ++counts_->by_client[client];
  Slot slot;
  slot.address_ = address;
  slot.counted_ = std::shared_ptr<void>(nullptr, [counts = counts_, client](void*) {
    --counts->in_all;
    const auto entry = counts->by_client.find(client);
    if (--entry->second == 0) counts->by_client.erase(entry);
  });
  return slot;
}

}  // namespace heliograph::net
