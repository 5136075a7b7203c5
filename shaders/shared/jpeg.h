// Baseline JPEG with chroma at half the size (4:2:0), coded in restart intervals of equal length,
// each by one workgroup (ITU-T T.81).
#ifndef HELIOGRAPH_SHARED_JPEG_H
#define HELIOGRAPH_SHARED_JPEG_H
#include "types.h"
SHARED_BEGIN

SHARED_CONSTANT uint jpeg_mcu_side = 16u;      // pixels
SHARED_CONSTANT uint jpeg_mcu_blocks = 6u;     // four of luma, row by row, Cb, Cr
SHARED_CONSTANT uint jpeg_interval_mcus = 4u;  // of each restart interval but the last
SHARED_CONSTANT uint jpeg_interval_blocks = 24u;

// Room for one coded interval. Coefficients of an 8-bit image take some 16 bits each at most, over
// a whole interval; there are 20 for each. Where they are not enough, the frame's pixels come where
// its JPEG would be.
SHARED_CONSTANT uint jpeg_slot_words = 960u;
// In place of the length of an interval that does not fit.
SHARED_CONSTANT uint jpeg_too_long = 0xffffffffu;

// A code of Huffman's, shifted to the left by 8, and its length in bits.
struct JpegTables {
  uint coding_order[64];   // by 8 * row + column
  uint quantisation[128];  // by the same, at quality 50: of luma, then of chroma
  uint dc_codes[32];       // by category: of luma, then of chroma
  uint ac_codes[512];      // by symbol, likewise
  // Of a coded interval: a longer one does not fit. No more than a slot has room for.
  uint most_interval_bytes;
};

SHARED_END
#endif
