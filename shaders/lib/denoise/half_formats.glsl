// The format of what halves of iterations write. A shader defines SIGNAL_IN_FLOATS where it reads
// what is blurred, and FILTERED_IN_FLOATS where it writes the result: these hold 32 bits, all others
// 16. One that defines FILTERED_IS_RESULT writes the result in 16 bits, with variances as they are.
#ifdef FILTERED_IN_FLOATS
#define FILTERED_FORMAT rgba32f
#else
#define FILTERED_FORMAT rgba16f
#endif
