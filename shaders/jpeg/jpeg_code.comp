#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
layout(local_size_x = 192) in;
// One restart interval of a JPEG: colour conversion, down-sampling, forward DCT, quantisation,
// Huffman codes and byte stuffing. Eight invocations work on a block: each transforms one row, then
// one column, and codes eight coefficients. Colours, transform and rounding are those of
// libjpeg-turbo's accurate integer DCT, so that decoded images are the same.
#include "shared/jpeg.h"

layout(set = 1, binding = 0, rgba8) readonly uniform image2D shown;
layout(set = 1, binding = 1, std430) readonly buffer TablesBlock { JpegTables tables; };
layout(set = 1, binding = 2, std430) writeonly buffer Slots { uint slots[]; };
layout(set = 1, binding = 3, std430) writeonly buffer Lengths { uint lengths[]; };  // bytes
layout(push_constant) uniform Constants {
  uvec2 source;   // of the image, pixels
  uvec2 size;     // that is encoded: no larger
  uint mcus;      // in all
  uint mcus_wide;
  uint percent;   // of the tables for quality 50
};

const uint threads = 192u;
const uint row_stride = 9u;  // spreads rows and columns over the banks of shared memory
const uint block_stride = 72u;
const uint sum_bits = 0u, sum_ones = jpeg_interval_blocks;  // in `block_sums`

/// Samples, then coefficients in coding order, then the bytes to store in the order of memory.
shared int samples[jpeg_interval_blocks * block_stride];
shared uint coded[jpeg_slot_words];                 // bits in the order of the file
shared uint nonzero[2u * jpeg_interval_blocks];     // a bit for each coefficient of a block
shared uint counts[threads];
shared uint block_sums[2u * jpeg_interval_blocks];  // of the counts of a block's threads

uvec3 color_at(uvec2 pixel) {
  return uvec3(imageLoad(shown, ivec2(pixel)).rgb * 255.0 + 0.5);
}

/// The mean of the area that a pixel of the encoded image covers. Weights are in units of 1 / `size`
/// of a pixel of the image; sums are exact up to 2^24 pixels.
uvec3 mean_at(uvec2 pixel) {
  uvec2 begin = pixel * source;
  uvec2 end = begin + source;
  uvec3 sum = uvec3(0u);
  for (uint y = begin.y / size.y; y * size.y < end.y; ++y) {
    uint high = min(end.y, (y + 1u) * size.y) - max(begin.y, y * size.y);
    uvec3 row = uvec3(0u);
    for (uint x = begin.x / size.x; x * size.x < end.x; ++x) {
      uint wide = min(end.x, (x + 1u) * size.x) - max(begin.x, x * size.x);
      row += wide * color_at(uvec2(x, y));
    }
    sum += high * row;
  }
  uint area = source.x * source.y;
  return (sum + area / 2u) / area;
}

/// Those of two by two pixels, the nearest ones inside where they lie outside.
void colors_at(ivec2 corner, out ivec3 colors[4]) {
  ivec2 last = ivec2(size) - 1;
  if (size == source) {
    for (int i = 0; i < 4; ++i) {
      colors[i] = ivec3(color_at(uvec2(min(corner + ivec2(i & 1, i >> 1), last))));
    }
  } else {
    for (int i = 0; i < 4; ++i) {
      colors[i] = ivec3(mean_at(uvec2(min(corner + ivec2(i & 1, i >> 1), last))));
    }
  }
}

// Fixed point with 16 bits behind the point, rounded as libjpeg does.
int luma_of(ivec3 c) {
  return (19595 * c.r + 38470 * c.g + 7471 * c.b + 32768) >> 16;
}
ivec2 chroma_of(ivec3 c) {
  return ivec2(32768 * c.b - 11059 * c.r - 21709 * c.g,
               32768 * c.r - 27439 * c.g - 5329 * c.b) + (8388608 + 32767) >> 16;
}

/// The samples of four pixels, around zero: what lies outside repeats the border, of chroma after
/// down-sampling.
void load_quad(uint mcu_in_interval, uvec2 mcu_place, uvec2 quad) {
  ivec2 corner = ivec2(mcu_place * jpeg_mcu_side + 2u * quad);
  ivec3 colors[4];
  colors_at(corner, colors);
  uint first_block = mcu_in_interval * jpeg_mcu_blocks;
  uvec2 half_block = quad >> 2u;
  uvec2 place = 2u * (quad & 3u);
  uint luma = (first_block + 2u * half_block.y + half_block.x) * block_stride +
              place.y * row_stride + place.x;
  for (uint i = 0u; i < 4u; ++i) {
    samples[luma + (i >> 1u) * row_stride + (i & 1u)] = luma_of(colors[i]) - 128;
  }
  int chroma_row = 2 * min(corner.y / 2, int(size.y - 1u) / 2);
  if (chroma_row != corner.y) colors_at(ivec2(corner.x, chroma_row), colors);
  ivec2 chroma = ivec2(1 + int(quad.x & 1u));
  for (uint i = 0u; i < 4u; ++i) chroma += chroma_of(colors[i]);
  chroma = (chroma >> 2) - 128;
  uint in_block = quad.y * row_stride + quad.x;
  samples[(first_block + 4u) * block_stride + in_block] = chroma.x;
  samples[(first_block + 5u) * block_stride + in_block] = chroma.y;
}

/// Of MCUs behind the last one, the border.
void load_interval(uint first_mcu, uint thread) {
  uvec2 first_place = uvec2(first_mcu % mcus_wide, first_mcu / mcus_wide);
  for (uint i = thread; i < 64u * jpeg_interval_mcus; i += threads) {
    uvec2 place = first_place + uvec2(i / 64u, 0u);
    for (; place.x >= mcus_wide; place.x -= mcus_wide) ++place.y;
    load_quad(i / 64u, place, uvec2(i % 8u, i / 8u % 8u));
  }
}

/// Eight samples, `stride` apart, to their DCT (Loeffler, Ligtenberg and Moschytz 1989) with 13
/// bits behind the point in constants. The even frequencies 0 and 4 come without them, scaled by
/// `gain` bits, all others rounded by `shift`.
void transform(uint first, uint stride, int gain, int shift, out int result[8]) {
  int s[8];
  for (uint i = 0u; i < 8u; ++i) s[i] = samples[first + i * stride];
  ivec4 sums = ivec4(s[0] + s[7], s[1] + s[6], s[2] + s[5], s[3] + s[4]);
  ivec4 differences = ivec4(s[3] - s[4], s[2] - s[5], s[1] - s[6], s[0] - s[7]);
  ivec2 outer = ivec2(sums.x + sums.w, sums.y + sums.z);
  ivec2 inner = ivec2(sums.x - sums.w, sums.y - sums.z);
  int dc = outer.x + outer.y;
  int middle = outer.x - outer.y;
  result[0] = gain >= 0 ? dc << gain : (dc + (1 << (-gain - 1))) >> -gain;
  result[4] = gain >= 0 ? middle << gain : (middle + (1 << (-gain - 1))) >> -gain;
  int round = 1 << (shift - 1);
  int turn = (inner.x + inner.y) * 4433;
  result[2] = (turn + inner.x * 6270 + round) >> shift;
  result[6] = (turn - inner.y * 15137 + round) >> shift;
  int a = -7373 * (differences.x + differences.w);
  int b = -20995 * (differences.y + differences.z);
  int c = differences.x + differences.z;
  int d = differences.y + differences.w;
  int both = 9633 * (c + d);
  c = both - 16069 * c;
  d = both - 3196 * d;
  result[7] = (2446 * differences.x + a + c + round) >> shift;
  result[5] = (16819 * differences.y + b + d + round) >> shift;
  result[3] = (25172 * differences.z + b + c + round) >> shift;
  result[1] = (12299 * differences.w + a + d + round) >> shift;
}

uint quantiser(uint channel, uint place) {
  return clamp((tables.quantisation[64u * channel + place] * percent + 50u) / 100u, 1u, 255u);
}

/// Both halves of the transform and quantisation of this thread's block.
void transform_block(uint block, uint part) {
  uint first = block * block_stride;
  int line[8];
  transform(first + part * row_stride, 1u, 2, 11, line);
  for (uint i = 0u; i < 8u; ++i) samples[first + part * row_stride + i] = line[i];
  barrier();
  transform(first + part, row_stride, -2, 15, line);
  barrier();
  uint channel = block % jpeg_mcu_blocks < 4u ? 0u : 1u;
  uvec2 found = uvec2(0u);
  for (uint row = 0u; row < 8u; ++row) {
    uint place = 8u * row + part;
    uint divisor = 8u * quantiser(channel, place);
    // Below 2^15, and half of one from what rounds otherwise: exact in floats.
    float dividend = float(uint(abs(line[row])) + divisor / 2u) + 0.5;
    int magnitude = int(dividend / float(divisor));
    uint order = tables.coding_order[place];
    samples[first + order] = line[row] < 0 ? -magnitude : magnitude;
    uint bit = magnitude != 0 ? 1u << (order & 31u) : 0u;
    found |= order < 32u ? uvec2(bit, 0u) : uvec2(0u, bit);
  }
  if (found.x != 0u) atomicOr(nonzero[2u * block], found.x);
  if (found.y != 0u) atomicOr(nonzero[2u * block + 1u], found.y);
}

/// A code word: its bits, shifted to the left by 5, and how many they are, 26 at most.
uint word_of(uint code, int value, uint category) {
  uint bits = uint(value < 0 ? value - 1 : value) & ((1u << category) - 1u);
  return ((code >> 8) << category | bits) << 5 | (code & 255u) + category;
}

uint category_of(int value) {
  return uint(findMSB(uint(abs(value))) + 1);
}

/// That of the block before of the same channel in this interval.
int predicted_dc(uint block) {
  uint in_mcu = block % jpeg_mcu_blocks;
  uint back = in_mcu == 0u ? 3u : in_mcu < 4u ? 1u : jpeg_mcu_blocks;
  return block < back ? 0 : samples[(block - back) * block_stride];
}

/// What a thread codes, in this order.
struct Part {
  uint sixteen;   // the code of sixteen zeros
  uint sixteens;  // how often
  uint words[8];  // of its coefficients; 0: none
  uint end;       // of the block; likewise
};

/// The place of the last coefficient before those of `part` that is not 0; the first counts.
uint last_before(uvec2 bits, uint part) {
  uint high = part > 4u ? bits.y & ((1u << (8u * part - 32u)) - 1u) : 0u;
  uint low = part < 4u ? bits.x & ((1u << (8u * part)) - 1u) : bits.x;
  return uint(high != 0u ? 32 + findMSB(high) : findMSB(low | 1u));
}

Part code_part(uint block, uint part) {
  uint first = block * block_stride;
  uint channel = block % jpeg_mcu_blocks < 4u ? 0u : 1u;
  uint codes = 256u * channel;
  uvec2 bits = uvec2(nonzero[2u * block], nonzero[2u * block + 1u]);
  uint before = last_before(bits, part);
  Part coded_part;
  uint sixteen = tables.ac_codes[codes + 0xf0u];
  coded_part.sixteen = (sixteen >> 8) << 5 | sixteen & 255u;
  coded_part.sixteens = 0u;
  // Code words are looked up for zeros, too, so that none of them waits for another.
  [[unroll]] for (uint i = 0u; i < 8u; ++i) {
    uint place = 8u * part + i;
    int value = samples[first + place];
    uint category = category_of(value);
    uint run = place - before - 1u;
    uint word = word_of(tables.ac_codes[codes + ((run & 15u) << 4 | category)], value, category);
    bool counts_here = value != 0 && place > 0u;
    coded_part.words[i] = counts_here ? word : 0u;
    // Only the first is that far from the one before it.
    if (counts_here) {
      coded_part.sixteens += run >> 4;
      before = place;
    }
  }
  if (part == 0u) {
    int difference = samples[first] - predicted_dc(block);
    uint category = category_of(difference);
    uint code = tables.dc_codes[16u * channel + category];
    coded_part.words[0] = word_of(code, difference, category);
  }
  uint end = tables.ac_codes[codes];
  bool ends = part == 7u && bits.y >> 31 == 0u;
  coded_part.end = ends ? (end >> 8) << 5 | end & 255u : 0u;
  return coded_part;
}

uint length_of(Part part) {
  uint length = part.sixteens * (part.sixteen & 31u) + (part.end & 31u);
  [[unroll]] for (uint i = 0u; i < 8u; ++i) length += part.words[i] & 31u;
  return length;
}

/// Where the next bits go, and those before them in the same word that are not stored yet.
uint position;
uint pending = 0u;

void put(uint word) {
  uint length = word & 31u;
  if (length == 0u) return;
  uint bits = word >> 5;
  int shift = 32 - int(position & 31u) - int(length);
  if (shift > 0) {
    pending |= bits << shift;
  } else {
    atomicOr(coded[position >> 5], pending | bits >> -shift);
    pending = shift < 0 ? bits << (32 + shift) : 0u;
  }
  position += length;
}

/// From the bit `begin` on.
void write_part(Part part, uint begin) {
  position = begin;
  for (uint i = 0u; i < part.sixteens; ++i) put(part.sixteen);
  [[unroll]] for (uint i = 0u; i < 8u; ++i) put(part.words[i]);
  put(part.end);
  if (pending != 0u) atomicOr(coded[position >> 5], pending);
}

/// The sum of the counts of all threads before this one; `all` of every one. `sums`: where those of
/// blocks are, which are 0 before.
uint sum_before(uint thread, uint count, uint sums, out uint all) {
  uint block = thread / 8u;
  counts[thread] = count;
  if (count != 0u) atomicAdd(block_sums[sums + block], count);
  barrier();
  uint before = 0u;
  all = 0u;
  [[unroll]] for (uint i = 0u; i < jpeg_interval_blocks; ++i) {
    uint sum = block_sums[sums + i];
    before += i < block ? sum : 0u;
    all += sum;
  }
  [[unroll]] for (uint i = 0u; i < 7u; ++i) before += i < thread % 8u ? counts[8u * block + i] : 0u;
  return before;
}

/// The lowest bit of each byte whose bits are all set.
uint ones_of(uint word) {
  word &= word >> 1;
  word &= word >> 2;
  return word & word >> 4 & 0x01010101u;
}

/// From the order of the file to that of memory.
uint swapped(uint word) {
  return word << 24 | (word & 0xff00u) << 8 | word >> 8 & 0xff00u | word >> 24;
}

/// Four coded bytes, from byte `to` on. A byte of ones is followed by a zero.
void stuff(uint word, uint to) {
  if (ones_of(word) == 0u) {
    uint bytes = swapped(word);
    uint shift = 8u * (to & 3u);
    atomicOr(samples[to >> 2], int(bytes << shift));
    if (shift != 0u) atomicOr(samples[(to >> 2) + 1u], int(bytes >> (32u - shift)));
    return;
  }
  for (uint i = 0u; i < 4u; ++i, ++to) {
    uint value = word >> (24u - 8u * i) & 255u;
    atomicOr(samples[to >> 2], int(value << (8u * (to & 3u))));
    if (value == 255u) ++to;
  }
}

void store_length(uint thread, uint interval, uint length) {
  if (thread == 0u) lengths[interval] = length;
}

/// Stuffs and stores an interval of `bytes` coded bytes.
void store_interval(uint thread, uint interval, uint bytes) {
  uint words = (bytes + 3u) / 4u;
  uint share = (words + threads - 1u) / threads;
  uint first = min(thread * share, words);
  uint end = min(first + share, words);
  uint ones = 0u;
  for (uint i = first; i < end; ++i) ones += bitCount(ones_of(coded[i]));
  // Coefficients are not needed any more: room for as many bytes again.
  uint room = min(2u * words, jpeg_slot_words) + 1u;
  for (uint i = thread; i < room; i += threads) samples[i] = 0;
  uint all_ones;
  uint to = 4u * first + sum_before(thread, ones, sum_ones, all_ones);
  bool fits = bytes + all_ones <= tables.most_interval_bytes;
  store_length(thread, interval, fits ? bytes + all_ones : jpeg_too_long);
  if (!fits) return;
  uint slot = interval * jpeg_slot_words;
  if (all_ones == 0u) {
    for (uint i = thread; i < words; i += threads) slots[slot + i] = swapped(coded[i]);
    return;
  }
  for (uint i = first; i < end; ++i) {
    stuff(coded[i], to);
    to += 4u + bitCount(ones_of(coded[i]));
  }
  barrier();
  for (uint i = thread; i < (bytes + all_ones + 3u) / 4u; i += threads) {
    slots[slot + i] = uint(samples[i]);
  }
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint interval = gl_WorkGroupID.x;
  uint first_mcu = interval * jpeg_interval_mcus;
  if (first_mcu >= mcus) return;
  for (uint i = thread; i < jpeg_slot_words; i += threads) coded[i] = 0u;
  if (thread < 2u * jpeg_interval_blocks) nonzero[thread] = block_sums[thread] = 0u;
  load_interval(first_mcu, thread);
  barrier();
  uint block = thread / 8u;
  transform_block(block, thread % 8u);
  barrier();
  Part part = code_part(block, thread % 8u);
  bool used = block < (mcus - first_mcu) * jpeg_mcu_blocks;
  uint coded_bits;
  uint begin = sum_before(thread, used ? length_of(part) : 0u, sum_bits, coded_bits);
  uint bytes = (coded_bits + 7u) / 8u;
  if (bytes > 4u * jpeg_slot_words) {
    store_length(thread, interval, jpeg_too_long);
    return;
  }
  if (used) write_part(part, begin);
  uint padding = 8u * bytes - coded_bits;
  if (thread == 0u && padding != 0u) {
    uint shift = 32u - padding - (coded_bits & 31u);
    atomicOr(coded[coded_bits >> 5], ((1u << padding) - 1u) << shift);
  }
  barrier();
  store_interval(thread, interval, bytes);
}
