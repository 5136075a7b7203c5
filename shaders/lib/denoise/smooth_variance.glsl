// Variance that guides a filter of `signal`, an image of the shader that includes this.

/// Variance over 3x3 pixels with weights 1 2 1: one pixel's own estimate is too noisy to guide.
vec2 smooth_variance(ivec2 pixel, ivec2 extent) {
  ivec2 last = extent - 1;
  vec2 sum = vec2(0.0);
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float weight = float((2 - abs(x)) * (2 - abs(y))) / 16.0;
      ivec2 tap = clamp(pixel + ivec2(x, y), ivec2(0), last);
      sum += weight * variance_of(imageLoad(signal, tap));
    }
  }
  return sum;
}
