#include "scene/image/ktx2/etc1s.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace heliograph::scene::ktx2 {
namespace {

[[noreturn]] void refuse(const char* reason) {
  throw ImportError(std::string("is a damaged KTX2: ") + reason);
}

// Of ETC1, by intensity and selector.
constexpr int modifiers[8][4] = {{-8, -2, 2, 8},       {-17, -5, 5, 17},    {-29, -9, 9, 29},
                                 {-42, -13, 13, 42},   {-60, -18, 18, 60},  {-80, -24, 24, 80},
                                 {-106, -33, 33, 106}, {-183, -47, 47, 183}};

/// Numbers in groups of `group` bits, each with one more bit: whether another one follows.
std::uint32_t read_groups(BitReader& bits, std::uint32_t group) {
  std::uint32_t value = 0;
  for (std::uint32_t shift = 0; shift < 32; shift += group) {
    const std::uint32_t part = bits.read(group + 1);
    value |= (part & ((1u << group) - 1u)) << shift;
    if (part >> group == 0) return value;
  }
  refuse("a number of its data does not end");
}

/// The selectors used last, approximately in the order of their use.
class SelectorHistory {
 public:
  explicit SelectorHistory(std::uint32_t size) : values_(size), next_(size / 2) {}

  void add(std::uint32_t value) {
    if (values_.empty()) return;
    values_[next_++] = value;
    if (next_ == values_.size()) next_ = values_.size() / 2;
  }
  std::uint32_t use(std::uint32_t index) {
    if (index >= values_.size()) refuse("it refers to selectors that it did not use");
    const std::uint32_t value = values_[index];
    std::swap(values_[index], values_[index / 2]);
    return value;
  }

 private:
  std::vector<std::uint32_t> values_;
  std::size_t next_;
};

}  // namespace

/// Decodes the numbers of the endpoint and the selector of one block after the other.
class Etc1sDecoder::SliceReader {
 public:
  SliceReader(const Etc1sDecoder& decoder, std::span<const std::uint8_t> slice,
              std::uint32_t columns)
      : tables_(decoder.tables_),
        endpoint_count_(decoder.endpoints_.size()),
        selector_count_(decoder.selectors_.size()),
        bits_(slice),
        history_(decoder.tables_.history_size),
        above_(columns),
        current_(columns),
        row_predictions_((columns + 1) / 2) {}

  void begin_row() { std::swap(above_, current_); }

  std::uint32_t read_endpoint(std::uint32_t x, std::uint32_t y) {
    if (x % 2 == 0) read_predictions(x, y);
    const std::uint32_t prediction = predictions_ & 3u;
    predictions_ >>= 2;
    endpoint_ = predicted(prediction, x, y);
    current_[x] = endpoint_;
    return endpoint_;
  }

  std::uint32_t read_selector() {
    const std::uint32_t symbol = read_selector_symbol();
    if (symbol >= selector_count_) return history_.use(symbol - selector_count_);
    history_.add(symbol);
    return symbol;
  }

 private:
  static constexpr std::uint32_t repeat_predictions = 256;
  static constexpr std::uint32_t least_repeats = 3;
  static constexpr std::uint32_t longest_short_run = 63;

  /// Predictions are coded for 2 x 2 blocks at once.
  void read_predictions(std::uint32_t x, std::uint32_t y) {
    if (y % 2 == 1) {
      predictions_ = row_predictions_[x / 2];
      return;
    }
    if (prediction_repeats_ > 0) {
      --prediction_repeats_;
    } else {
      const std::uint32_t symbol = tables_.endpoint_prediction.decode(bits_);
      if (symbol > repeat_predictions) refuse("it has an unknown prediction");
      if (symbol == repeat_predictions) {
        prediction_repeats_ = read_groups(bits_, 4) + least_repeats - 1;
      } else {
        last_predictions_ = symbol;
      }
    }
    predictions_ = last_predictions_;
    row_predictions_[x / 2] = predictions_ >> 4;
  }

  std::uint32_t predicted(std::uint32_t prediction, std::uint32_t x, std::uint32_t y) {
    const bool outside = (prediction != 1 && x == 0) || (prediction != 0 && y == 0);
    if (prediction < 3 && outside) refuse("it refers to blocks outside of the image");
    if (prediction == 0) return endpoint_;
    if (prediction == 1) return above_[x];
    if (prediction == 2) return above_[x - 1];
    const std::size_t index = endpoint_ + tables_.endpoint_delta.decode(bits_);
    const std::size_t wrapped = index >= endpoint_count_ ? index - endpoint_count_ : index;
    if (wrapped >= endpoint_count_) refuse("it refers to endpoints that it does not have");
    return static_cast<std::uint32_t>(wrapped);
  }

  std::uint32_t read_selector_symbol() {
    const auto newest = static_cast<std::uint32_t>(selector_count_);
    if (selector_repeats_ > 0) {
      --selector_repeats_;
      return newest;
    }
    const std::uint32_t symbol = tables_.selector.decode(bits_);
    if (symbol != newest + tables_.history_size) return symbol;
    const std::uint32_t run = tables_.selector_run.decode(bits_);
    selector_repeats_ =
        (run == longest_short_run ? read_groups(bits_, 7) : run) + least_repeats - 1;
    return newest;
  }

  const Tables& tables_;
  std::size_t endpoint_count_;
  std::size_t selector_count_;
  BitReader bits_;
  SelectorHistory history_;
  std::vector<std::uint32_t> above_;  // endpoints of the row above
  std::vector<std::uint32_t> current_;
  std::vector<std::uint32_t> row_predictions_;  // of the row below
  std::uint32_t predictions_ = 0;
  std::uint32_t last_predictions_ = 0;
  std::uint32_t prediction_repeats_ = 0;
  std::uint32_t selector_repeats_ = 0;
  std::uint32_t endpoint_ = 0;
};

Etc1sDecoder::Etc1sDecoder(std::uint32_t endpoint_count, std::span<const std::uint8_t> endpoints,
                           std::uint32_t selector_count, std::span<const std::uint8_t> selectors,
                           std::span<const std::uint8_t> tables)
    : endpoints_(read_endpoints(endpoint_count, endpoints)),
      selectors_(read_selectors(selector_count, selectors)),
      tables_(read_tables(tables)) {}

std::vector<Etc1sDecoder::Endpoint> Etc1sDecoder::read_endpoints(
    std::uint32_t count, std::span<const std::uint8_t> bytes) {
  BitReader bits(bytes);
  // By the range of the value before: 0..9, 10..21, 22..31.
  const std::array<HuffmanCode, 3> color_deltas = {HuffmanCode::read(bits), HuffmanCode::read(bits),
                                                   HuffmanCode::read(bits)};
  const HuffmanCode intensity_delta = HuffmanCode::read(bits);
  const bool gray = bits.read(1) != 0;
  const auto advance = [&](std::uint8_t& value) {
    const std::size_t range = value <= 9 ? 0 : value <= 21 ? 1 : 2;
    value = static_cast<std::uint8_t>((value + color_deltas[range].decode(bits)) & 31u);
  };
  std::vector<Endpoint> result(count);
  Endpoint last{16, 16, 16, 0};
  for (Endpoint& endpoint : result) {
    last.intensity =
        static_cast<std::uint8_t>((last.intensity + intensity_delta.decode(bits)) & 7u);
    advance(last.red);
    if (gray) {
      last.green = last.blue = last.red;
    } else {
      advance(last.green);
      advance(last.blue);
    }
    endpoint = last;
  }
  return result;
}

std::vector<Etc1sDecoder::Selector> Etc1sDecoder::read_selectors(
    std::uint32_t count, std::span<const std::uint8_t> bytes) {
  BitReader bits(bytes);
  if (bits.read(2) != 0) refuse("its selectors have an unknown form");
  const bool raw = bits.read(1) != 0;
  std::vector<Selector> result(count);
  if (raw) {
    for (Selector& selector : result) {
      for (std::uint8_t& row : selector) row = static_cast<std::uint8_t>(bits.read(8));
    }
    return result;
  }
  const HuffmanCode delta = HuffmanCode::read(bits);
  for (std::size_t i = 0; i < result.size(); ++i) {
    for (std::size_t row = 0; row < 4; ++row) {
      result[i][row] = static_cast<std::uint8_t>(i == 0 ? bits.read(8)
                                                        : delta.decode(bits) ^ result[i - 1][row]);
    }
  }
  return result;
}

Etc1sDecoder::Tables Etc1sDecoder::read_tables(std::span<const std::uint8_t> bytes) {
  BitReader bits(bytes);
  return {HuffmanCode::read(bits), HuffmanCode::read(bits), HuffmanCode::read(bits),
          HuffmanCode::read(bits), bits.read(13)};
}

void Etc1sDecoder::draw(const Endpoint& endpoint, const Selector& selector, std::uint32_t left,
                        std::uint32_t top, ImageSize size, Channels channels,
                        std::span<std::uint8_t> rgba) {
  const auto expand = [](std::uint8_t value) { return value << 3 | value >> 2; };
  const std::array<int, 3> base = {expand(endpoint.red), expand(endpoint.green),
                                   expand(endpoint.blue)};
  for (std::uint32_t y = 0; y < 4 && top + y < size.height; ++y) {
    for (std::uint32_t x = 0; x < 4 && left + x < size.width; ++x) {
      const int modifier = modifiers[endpoint.intensity][selector[y] >> (2 * x) & 3];
      const auto channel = [&](std::size_t i) {
        return static_cast<std::uint8_t>(std::clamp(base[i] + modifier, 0, 255));
      };
      std::uint8_t* const texel = rgba.data() + 4 * (std::size_t(top + y) * size.width + left + x);
      if (channels == Channels::alpha) {
        texel[3] = channel(1);
      } else {
        for (std::size_t i = 0; i < 3; ++i) texel[i] = channel(i);
        texel[3] = 255;
      }
    }
  }
}

void Etc1sDecoder::decode(std::span<const std::uint8_t> slice, ImageSize size, Channels channels,
                          std::span<std::uint8_t> rgba) const {
  const std::uint32_t columns = (size.width + 3) / 4;
  const std::uint32_t rows = (size.height + 3) / 4;
  SliceReader reader(*this, slice, columns);
  for (std::uint32_t y = 0; y < rows; ++y) {
    reader.begin_row();
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t endpoint = reader.read_endpoint(x, y);
      const std::uint32_t selector = reader.read_selector();
      if (endpoint >= endpoints_.size() || selector >= selectors_.size()) {
        refuse("it refers to entries of its codebooks that it does not have");
      }
      draw(endpoints_[endpoint], selectors_[selector], 4 * x, 4 * y, size, channels, rgba);
    }
  }
}

}  // namespace heliograph::scene::ktx2
