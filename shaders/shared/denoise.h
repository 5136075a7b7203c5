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

// What a visibility's change is where no sample was taken: it lies in -1..1 otherwise.
SHARED_CONSTANT float change_unknown = 2.0f;

SHARED_CONSTANT uint temporal_history_valid = 1u;  // the frame before has a history
SHARED_CONSTANT uint temporal_mean_variance = 2u;  // variance of the mean, not of one sample
SHARED_CONSTANT uint temporal_virtual_motion = 4u;
SHARED_CONSTANT uint temporal_curved_reflectors = 8u;  // virtual motion follows their curvature
SHARED_CONSTANT uint temporal_bicubic = 16u;           // fetches the history with a cubic

struct TemporalConstants {
  float frames;          // maximum history length
  float moments_frames;  // maximum history length of the moments
  uint rectification;
  int radius;                     // of the rectification's window, pixels
  float scale;                    // of its box, standard deviations
  float spatial_variance_frames;  // shorter histories take their variance from neighbours
  uint flags;                     // temporal_*
  float light_frames;             // maximum history length of what moving lights light
  float environment_turn;         // since the frame before, radians, where that is followed
};

// Constants of the temporal filters that were fitted by measurement. The tests named here pin them.

// frames_under_motion: the error of a mean over n frames of noise s and lag m n is least for n
// proportional to m^(-2/3); the factor was fitted to moving lights with the blur behind it.
// Moments.HistoryLengthUnderMotion.
SHARED_CONSTANT float motion_history_factor = 0.63f;
SHARED_CONSTANT float motion_history_exponent = -2.0f / 3.0f;
// specular_temporal, max_history_frames: only part of a reflection is lit directly by moving
// lights, so its history may be this much longer than that of shadows.
// TemporalAccumulation.MovingLightsShortenSpecularHistoryLess.
SHARED_CONSTANT float specular_light_history_scale = 4.0f;

// virtual_motion_threshold: half of the drift that noisy hit distances cause, per pixel of the
// lobe's width. VirtualMotion.ThresholdGrowsWithTheLobe.
SHARED_CONSTANT float virtual_threshold_per_pixel = 1.0f / 64.0f;
SHARED_CONSTANT float virtual_threshold_max = 0.5f;  // pixels
// max_virtual_history: frames per pixel of the lobe's width beyond the least width that needs a
// history at all. VirtualMotion.HistoryGrowsWithTheLobe.
SHARED_CONSTANT float virtual_history_per_pixel = 8.0f;
SHARED_CONSTANT float virtual_history_min_lobe = 0.25f;  // pixels
// surface_history_weight: pixels of separation over which the weight falls to 1/e, on a mirror and
// per alpha (roughness squared). VirtualMotion.SurfaceHistoryFallsWithTheSeparation.
SHARED_CONSTANT float surface_history_falloff_smooth = 0.25f;
SHARED_CONSTANT float surface_history_falloff_per_alpha = 64.0f;
// same_reflector: least cosine between the normals of a mirror and of a rough surface, and the
// allowed difference in roughness. VirtualMotion.ReflectorIsComparedByNormalAndRoughness.
SHARED_CONSTANT float reflector_cosine_smooth = 0.9995f;  // 1.8 degrees
SHARED_CONSTANT float reflector_cosine_rough = 0.95f;     // 18 degrees
SHARED_CONSTANT float reflector_roughness_tolerance = 0.05f;
SHARED_CONSTANT float reflector_roughness_tolerance_relative = 0.25f;
// virtual_motion: least cosine of incidence; Coddington's focus within the plane of incidence runs
// away toward grazing angles. Chosen on curved reflectors seen at grazing angles.
SHARED_CONSTANT float reflector_min_cosine = 0.2f;
// virtual_distance: bounds the magnification of hollow mirrors, whose image lies before them beyond
// the focus. VirtualDistance.FollowsTheMirrorEquation.
SHARED_CONSTANT float virtual_distance_min_divisor = 0.25f;
// valid_taps: least sum of bilinear weights that is renormalised.
// HistoryTaps.AreBilinearAndRenormaliseOverValidTaps.
SHARED_CONSTANT float min_tap_weight_sum = 0.01f;

// Histories of 16 bits: the rounding of a pixel changes from frame to frame by 2^32 times the
// golden ratio, less its whole part, so that its errors cancel out soon; of fractions it reaches
// over this part of a step. TemporalAccumulation.LongHistoryFollowsSmallChanges.
SHARED_CONSTANT uint rounding_step = 0x9e3779b9u;
SHARED_CONSTANT float rounding_range = 0.9375f;
SHARED_CONSTANT float largest_half = 65504.0f;
// What rounding changes a signal without noise by, which is no reason for rectification: of
// visibility, and of reflections in parts of their brightness.
SHARED_CONSTANT float visibility_rounding = 1.0f / 2048.0f;
SHARED_CONSTANT float specular_rounding = 1.0f / 1024.0f;

// mean_box: fewer pixels of a window do not tell its spread. Half of them are sampled where
// something moves; reflections have rare bright samples, which half of the pixels may miss.
SHARED_CONSTANT float min_sampled_fraction = 0.4f;
SHARED_CONSTANT float min_sampled_fraction_specular = 0.8f;

// outdated_fraction: part of a history that one frame may drop (Alber 2025).
SHARED_CONSTANT float max_outdated_fraction = 0.95f;

// Surfaces up to the first roughness reflect without noise of their own, up to the second with very
// little: they are blurred never and once. AtrousLevels.FollowRoughnessForNoiseFreeHits.
SHARED_CONSTANT float atrous_unblurred_roughness = 0.002f;
SHARED_CONSTANT float atrous_blurred_once_roughness = 0.05f;
// step_at: half of the band of roughness in which the step grows to twice its size.
// AtrousLevels.StepGrowsWithinABandOfRoughness.
SHARED_CONSTANT float atrous_step_half_band = 0.05f;

SHARED_CONSTANT uint atrous_variance_prefilter = 1u;
SHARED_CONSTANT uint atrous_keep_variance = 2u;  // this half passes the variance on unfiltered
SHARED_CONSTANT uint atrous_jitter = 4u;
SHARED_CONSTANT uint atrous_levels_by_roughness = 8u;
SHARED_CONSTANT uint atrous_lobe_limit = 16u;

// A kernel of (2 columns + 1) x (2 rows + 1) taps, 2^level texels apart.
struct AtrousConstants {
  int level;
  int columns;
  int rows;
  float luminance_sigma;
  float normal_power;
  float depth_sigma;
  float start_threshold;  // rougher pixels take twice the distance; -1: all, 2: none
  uint flags;             // atrous_*
  int pixels_per_texel;   // of the images, along each axis: 2 where they have half of the size
};

// visibility_upsample: what a pixel's own value weighs against the four texels of half size about
// it; about what the first iteration at full size leaves it.
// VisibilityUpsample.KeepsWhatIsKnownAtFullSize.
SHARED_CONSTANT float upsample_own_weight = 0.15f;

// indirect_halve: pixels of a square show one surface within this cosine of their normals and a
// change of view Z of so many slopes and of so much of itself. IndirectHalf.KeepsSurfacesApart.
SHARED_CONSTANT float half_size_cosine = 0.8f;
SHARED_CONSTANT float half_size_slopes = 3.0f;
SHARED_CONSTANT float half_size_depth = 0.005f;
// indirect_upsample: what a texel of another surface weighs, so that a pixel whose surface no texel
// shows takes those about it.
SHARED_CONSTANT float upsample_least = 1e-4f;

SHARED_END
#endif
