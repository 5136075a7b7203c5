// Reading the percentiles of tiles smoothly, so that no border of theirs shows. The shader that
// includes this binds them as `percentiles`.

vec4 percentiles_at(ivec2 pixel) {
  ivec2 last = imageSize(percentiles) - 1;
  vec2 place = (vec2(pixel) + 0.5) / 8.0 - 0.5;
  ivec2 corner = ivec2(floor(place));
  vec2 f = place - vec2(corner);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    vec2 share = mix(1.0 - f, f, vec2(offset));
    ivec2 tile = clamp(corner + offset, ivec2(0), last);
    sum += share.x * share.y * imageLoad(percentiles, tile);
  }
  return sum;
}
