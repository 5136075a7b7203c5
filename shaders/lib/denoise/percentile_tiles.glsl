// Reading the percentiles of tiles smoothly, so that no border of theirs shows. The shader that
// includes this binds them as `percentiles`.

vec4 percentiles_at(ivec2 pixel) {
  ivec2 last = (ivec2(frame.extent) + 7) / 8 - 1;
  vec2 position = (vec2(pixel) + 0.5) / 8.0 - 0.5;
  ivec2 corner = ivec2(floor(position));
  vec2 f = position - vec2(corner);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    vec2 weight = mix(1.0 - f, f, vec2(offset));
    ivec2 tile = clamp(corner + offset, ivec2(0), last);
    sum += weight.x * weight.y * texelFetch(percentiles, tile, 0);
  }
  return sum;
}
