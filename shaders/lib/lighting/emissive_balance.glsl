// The balance of light that arrives from emissive triangles by shadow rays and by gathering rays
// (multiple importance sampling; Veach 1997).
#ifndef HELIOGRAPH_EMISSIVE_BALANCE_GLSL
#define HELIOGRAPH_EMISSIVE_BALANCE_GLSL
#include "shared/emissive.h"

/// What a receiver gets of `point` under `cosine` / pi, `away` metres from it: its fraction of the
/// emission in the balance with a ray that has the density cosine / pi, so that it is bounded. `cosine_there`: of the point's normal.
float emissive_share(float density, float cosine_by_pi, float cosine_there, float away_squared) {
  float receiving = cosine_by_pi * cosine_there;
  float sending = float(emissive_candidates) * density * away_squared;
  return receiving / max(receiving + sending, 1e-30);
}

/// The fraction of emission that is left to a ray of the density `gathered` that has met what the
/// points have the density `sampled` of, both per steradian.
float gathered_share(float gathered, float sampled) {
  return gathered / max(gathered + float(emissive_candidates) * sampled, 1e-30);
}

#endif
