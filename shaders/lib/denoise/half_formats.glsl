// Formats of what halves of iterations read and write. A shader defines SIGNAL_IN_FLOATS where it
// reads what is blurred, and FILTERED_IN_FLOATS where it writes the result: these hold 32 bits. One
// that defines FILTERED_IS_RESULT writes the result in 16 bits, with variances as they are.
#ifdef SIGNAL_IN_FLOATS
#define SIGNAL_FORMAT rgba32f
#else
#define SIGNAL_FORMAT rgba16f
#endif
#ifdef FILTERED_IN_FLOATS
#define FILTERED_FORMAT rgba32f
#else
#define FILTERED_FORMAT rgba16f
#endif
