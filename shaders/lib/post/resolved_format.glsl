// Format of the frame that temporal antialiasing keeps: 32 bits a channel, and 16 where a shader
// defines RESOLVED_IN_HALVES.
#ifdef RESOLVED_IN_HALVES
#define RESOLVED_FORMAT rgba16f
#else
#define RESOLVED_FORMAT rgba32f
#endif
