// The path guide: from which parts of the hemisphere light has come to places of the world. std430.
#ifndef HELIOGRAPH_SHARED_PATH_GUIDE_H
#define HELIOGRAPH_SHARED_PATH_GUIDE_H
#include "types.h"
SHARED_BEGIN

// Entries lie in buckets, in any of whose slots an entry may be. Check 0: the slot is free.
SHARED_CONSTANT uint guide_entries = 4096u;
SHARED_CONSTANT uint guide_bucket = 4u;
// The hemisphere in bins of equal probability under a cosine distribution, bin by bin outward:
// rings around the normal of so many sectors.
SHARED_CONSTANT uint guide_rings = 4u;
SHARED_CONSTANT uint guide_sectors = 4u;
SHARED_CONSTANT uint guide_bins = 16u;
// Probabilities of bins are whole numbers out of so many, at least half of what it would be without
// a guide: no sample weighs more than twice.
SHARED_CONSTANT uint guide_whole = 256u;
SHARED_CONSTANT uint guide_least = 8u;
// An entry is so many powers of two larger than a cell of the radiance cache.
SHARED_CONSTANT int guide_coarser = 2;
// An entry that has learnt nothing for so many frames is freed.
SHARED_CONSTANT uint guide_lifetime = 64u;
// As soon as an entry has more samples than this, all count half as much.
SHARED_CONSTANT float guide_memory = 512.0f;
// After a change of light all count as so many, at most.
SHARED_CONSTANT float guide_memory_of_change = 32.0f;

struct GuideEntry {
  uint check;
  uint last_used;  // number of the frame
  uint padding0;
  uint padding1;
  uvec4 limits;  // where the probability of each bin begins, eight bits for one, out of guide_whole
  float squares[16];  // sums of the squared luminance that has come from each bin
  float counts[16];   // of samples
};

SHARED_END
#endif
