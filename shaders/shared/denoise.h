// Constants of the denoiser's passes: push constants, the same bytes in C++.
#ifndef HELIOGRAPH_SHARED_DENOISE_H
#define HELIOGRAPH_SHARED_DENOISE_H
#include "types.h"
SHARED_BEGIN

struct ReprojectConstants {
  float depth_tolerance;   // in changes of view Z from pixel to pixel
  float normal_tolerance;  // in changes of the normal from pixel to pixel
};

// Values of protocol::Rectification.
SHARED_CONSTANT uint rectification_off = 0u;
SHARED_CONSTANT uint rectification_color_clamp = 1u;
SHARED_CONSTANT uint rectification_color_clip = 2u;
SHARED_CONSTANT uint rectification_variance_clamp = 3u;
SHARED_CONSTANT uint rectification_variance_clip = 4u;
SHARED_CONSTANT uint rectification_fast_history = 5u;
SHARED_CONSTANT uint rectification_percentile = 6u;
SHARED_CONSTANT uint rectification_gradient = 7u;

SHARED_CONSTANT uint temporal_holds = 1u;          // there is a history
SHARED_CONSTANT uint temporal_mean_variance = 2u;  // variance of the mean, not of one sample
SHARED_CONSTANT uint temporal_virtual_motion = 4u;
SHARED_CONSTANT uint temporal_curved_reflectors = 8u;  // their virtual points, too
SHARED_CONSTANT uint temporal_bicubic = 16u;           // reads the remembered signal sharply

struct TemporalConstants {
  float frames;          // longest memory
  float moments_frames;  // longest memory of the moments
  uint rectification;
  int radius;                     // of the rectification's window, pixels
  float scale;                    // of its box, standard deviations
  float spatial_variance_frames;  // shorter histories take their variance from neighbours
  uint flags;                     // temporal_*
  float light_frames;             // longest memory of what comes from lights that move
  float environment_turn;         // since the frame before, radians, where that is followed
};

SHARED_CONSTANT uint atrous_variance_prefilter = 1u;
SHARED_CONSTANT uint atrous_keep_variance = 2u;  // this half passes the variance on unfiltered
SHARED_CONSTANT uint atrous_jitter = 4u;
SHARED_CONSTANT uint atrous_levels_by_roughness = 8u;
SHARED_CONSTANT uint atrous_lobe_limit = 16u;

// A kernel of (2 columns + 1) x (2 rows + 1) taps, 2^level pixels apart.
struct AtrousConstants {
  int level;
  int columns;
  int rows;
  float luminance_sigma;
  float normal_power;
  float depth_sigma;
  float start_threshold;  // rougher pixels take twice the distance; -1: all, 2: none
  uint flags;             // atrous_*
};

SHARED_END
#endif
