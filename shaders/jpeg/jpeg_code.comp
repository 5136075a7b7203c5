#version 460
#extension GL_GOOGLE_include_directive : require
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
const uint most_words = 1248u;  // of an interval before stuffing: 26 bits for each coefficient

shared int samples[jpeg_interval_blocks * block_stride];  // then coefficients, in coding order
shared uint coded[most_words];                            // bits in the order of the file
shared uint stuffed[jpeg_slot_words];                     // bytes in the order of memory
shared uint nonzero[threads];                             // a bit for each of eight coefficients
shared uint counts[threads];
shared uint block_counts[jpeg_interval_blocks];

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

// Fixed point with 16 bits behind the point, rounded as libjpeg does. Around zero.
ivec3 ycc_of(ivec2 pixel) {
  ivec3 c = ivec3(size == source ? color_at(uvec2(pixel)) : mean_at(uvec2(pixel)));
  return ivec3((19595 * c.r + 38470 * c.g + 7471 * c.b + 32768) / 65536 - 128,
               ((32768 * c.b - 11059 * c.r - 21709 * c.g) + 8388608 + 32767) / 65536 - 128,
               ((32768 * c.r - 27439 * c.g - 5329 * c.b) + 8388608 + 32767) / 65536 - 128);
}

/// The samples of four pixels: what lies outside repeats the border, of chroma after down-sampling.
void load_quad(uint mcu_in_interval, uint mcu, ivec2 quad) {
  ivec2 last = ivec2(size) - 1;
  ivec2 mcu_place = ivec2(mcu % mcus_wide, mcu / mcus_wide);
  ivec2 corner = mcu_place * int(jpeg_mcu_side) + 2 * quad;
  uint first_block = mcu_in_interval * jpeg_mcu_blocks;
  ivec2 half_block = quad / 4;
  uint luma = (first_block + uint(2 * half_block.y + half_block.x)) * block_stride;
  ivec2 place = 2 * (quad % 4);
  ivec2 chroma = ivec2(0);
  int chroma_row = 2 * min(corner.y / 2, last.y / 2);
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    ivec3 ycc = ycc_of(min(corner + offset, last));
    samples[luma + uint(place.y + offset.y) * row_stride + uint(place.x + offset.x)] = ycc.x;
    if (chroma_row != corner.y) ycc = ycc_of(min(ivec2(corner.x, chroma_row) + offset, last));
    chroma += ycc.yz + 128;
  }
  uint in_block = uint(quad.y) * row_stride + uint(quad.x);
  chroma = (chroma + 1 + (quad.x & 1)) / 4 - 128;
  samples[(first_block + 4u) * block_stride + in_block] = chroma.x;
  samples[(first_block + 5u) * block_stride + in_block] = chroma.y;
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
  for (uint row = 0u; row < 8u; ++row) {
    uint place = 8u * row + part;
    int divisor = 8 * int(quantiser(channel, place));
    int magnitude = (abs(line[row]) + divisor / 2) / divisor;
    samples[first + tables.coding_order[place]] = line[row] < 0 ? -magnitude : magnitude;
  }
}

/// Where the bits of a thread go: nowhere while it counts them.
uint position = 0u;
bool writes = false;

void put(uint bits, uint length) {
  if (writes && length > 0u) {
    int shift = 32 - int(position & 31u) - int(length);
    uint word = position >> 5;
    atomicOr(coded[word], shift >= 0 ? bits << shift : bits >> -shift);
    if (shift < 0) atomicOr(coded[word + 1u], bits << (32 + shift));
  }
  position += length;
}

/// A code with the bits of `value`, whose category it names.
void put_value(uint code, int value, uint category) {
  uint bits = uint(value < 0 ? value - 1 : value) & ((1u << category) - 1u);
  put((code >> 8) << category | bits, (code & 255u) + category);
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

/// The place of the last coefficient before those of `part` that is not 0; the first counts.
uint last_before(uint block, uint part) {
  for (uint i = part; i > 0u; --i) {
    uint bits = nonzero[8u * block + i - 1u];
    if (bits != 0u) return 8u * (i - 1u) + uint(findMSB(bits));
  }
  return 0u;
}

void code_part(uint block, uint part) {
  uint first = block * block_stride;
  uint channel = block % jpeg_mcu_blocks < 4u ? 0u : 1u;
  if (part == 0u) {
    int difference = samples[first] - predicted_dc(block);
    uint category = category_of(difference);
    put_value(tables.dc_codes[16u * channel + category], difference, category);
  }
  uint bits = nonzero[8u * block + part];
  uint before = last_before(block, part);
  while (bits != 0u) {
    uint place = 8u * part + uint(findLSB(bits));
    bits &= bits - 1u;
    uint run = place - before - 1u;
    uint sixteen = tables.ac_codes[256u * channel + 0xf0u];
    for (; run > 15u; run -= 16u) put(sixteen >> 8, sixteen & 255u);
    int value = samples[first + place];
    uint category = category_of(value);
    put_value(tables.ac_codes[256u * channel + (run << 4 | category)], value, category);
    before = place;
  }
  if (part == 7u && samples[first + 63u] == 0) {
    uint end = tables.ac_codes[256u * channel];
    put(end >> 8, end & 255u);
  }
}

/// The sum of the counts of all threads before this one; `all` of every one.
uint sum_before(uint thread, uint count, out uint all) {
  counts[thread] = count;
  barrier();
  if (thread < jpeg_interval_blocks) {
    uint sum = 0u;
    for (uint i = 0u; i < 8u; ++i) sum += counts[8u * thread + i];
    block_counts[thread] = sum;
  }
  barrier();
  uint before = 0u;
  all = 0u;
  for (uint i = 0u; i < jpeg_interval_blocks; ++i) {
    if (i < thread / 8u) before += block_counts[i];
    all += block_counts[i];
  }
  for (uint i = thread & ~7u; i < thread; ++i) before += counts[i];
  barrier();
  return before;
}

/// Byte `i` of what is coded.
uint coded_byte(uint i) {
  return coded[i >> 2] >> (24u - 8u * (i & 3u)) & 255u;
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint interval = gl_WorkGroupID.x;
  uint first_mcu = interval * jpeg_interval_mcus;
  if (first_mcu >= mcus) return;
  uint interval_mcus = min(jpeg_interval_mcus, mcus - first_mcu);
  for (uint i = thread; i < most_words; i += threads) coded[i] = 0u;
  for (uint i = thread; i < jpeg_slot_words; i += threads) stuffed[i] = 0u;
  for (uint i = thread; i < 64u * interval_mcus; i += threads) {
    load_quad(i / 64u, first_mcu + i / 64u, ivec2(i % 8u, i / 8u % 8u));
  }
  barrier();
  uint block = thread / 8u;
  uint part = thread % 8u;
  transform_block(block, part);
  barrier();
  bool used = block < interval_mcus * jpeg_mcu_blocks;
  uint bits = 0u;
  for (uint i = part == 0u ? 1u : 0u; i < 8u; ++i) {
    if (samples[block * block_stride + 8u * part + i] != 0) bits |= 1u << i;
  }
  nonzero[thread] = bits;
  barrier();
  if (used) code_part(block, part);
  uint coded_bits;
  position = sum_before(thread, position, coded_bits);
  writes = true;
  if (used) code_part(block, part);
  uint bytes = (coded_bits + 7u) / 8u;
  if (thread == 0u) {
    position = coded_bits;
    uint padding = 8u * bytes - coded_bits;
    put((1u << padding) - 1u, padding);
  }
  barrier();
  // A byte of ones is followed by a zero.
  uint share = ((bytes + 3u) / 4u + threads - 1u) / threads * 4u;
  uint end = min((thread + 1u) * share, bytes);
  uint ones = 0u;
  for (uint i = thread * share; i < end; ++i) ones += coded_byte(i) == 255u ? 1u : 0u;
  uint all_ones;
  uint to = thread * share + sum_before(thread, ones, all_ones);
  bool fits = bytes + all_ones <= tables.most_interval_bytes;
  if (thread == 0u) lengths[interval] = fits ? bytes + all_ones : jpeg_too_long;
  if (!fits) return;
  for (uint i = thread * share; i < end; ++i, ++to) {
    uint value = coded_byte(i);
    atomicOr(stuffed[to >> 2], value << (8u * (to & 3u)));
    if (value == 255u) ++to;
  }
  barrier();
  for (uint i = thread; i < (bytes + all_ones + 3u) / 4u; i += threads) {
    slots[interval * jpeg_slot_words + i] = stuffed[i];
  }
}
