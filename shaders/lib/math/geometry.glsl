#ifndef HELIOGRAPH_GEOMETRY_GLSL
#define HELIOGRAPH_GEOMETRY_GLSL

const float pi = 3.14159265358979;

/// Two unit vectors that complete `n` to a right-handed frame (Duff et al. 2017), which turns with
/// `n` steadily but near z = -s.
void signed_basis(vec3 n, float s, out vec3 tangent, out vec3 bitangent) {
  float a = -1.0 / (s + n.z);
  float b = n.x * n.y * a;
  tangent = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
  bitangent = vec3(b, s + n.y * n.y * a, -n.y);
}

void orthonormal_basis(vec3 n, out vec3 tangent, out vec3 bitangent) {
  signed_basis(n, n.z >= 0.0 ? 1.0 : -1.0, tangent, bitangent);
}

/// The same for directions that are stored: with a normal that differs by rounding they must come
/// back. So it turns at once where hardly any normal is, and not where those of all walls are.
void storage_basis(vec3 n, out vec3 tangent, out vec3 bitangent) {
  signed_basis(n, n.z >= -0.999 ? 1.0 : -1.0, tangent, bitangent);
}

/// The same, but so that normals which follow the same axis most have much the same frame.
void axis_basis(vec3 n, out vec3 tangent, out vec3 bitangent) {
  vec3 a = abs(n);
  bool follows_x = a.x >= a.y && a.x >= a.z;
  vec3 along = follows_x ? vec3(0, 1, 0) : a.y >= a.z ? vec3(0, 0, 1) : vec3(1, 0, 0);
  tangent = normalize(along - n * dot(along, n));
  bitangent = cross(n, tangent);
}

/// A ray origin off the surface at `position`, on the side `normal` points to, by what rounding
/// may have moved the position: seen from `distance` away it was rebuilt from a depth (measured:
/// below 2^-15 of the distance, with triangles a kilometre long), placed far from the origin of
/// the world it loses the last digits of its coordinates.
vec3 offset_origin(vec3 position, vec3 normal, float distance) {
  vec3 size = abs(position);
  float largest = max(size.x, max(size.y, size.z));
  return position + normal * max(distance * exp2(-15.0), largest * exp2(-20.0));
}

/// Cosine-distributed direction about `normal`; pdf = cos / pi.
vec3 sample_cosine(vec3 normal, vec2 u) {
  vec3 tangent, bitangent;
  orthonormal_basis(normal, tangent, bitangent);
  float radius = sqrt(u.x);
  float angle = 2.0 * pi * u.y;
  return normalize(tangent * (radius * cos(angle)) + bitangent * (radius * sin(angle)) +
                   normal * sqrt(max(0.0, 1.0 - u.x)));
}

/// The same in the frame of axis_basis().
vec3 sample_cosine_by_axis(vec3 normal, vec2 u) {
  vec3 tangent, bitangent;
  axis_basis(normal, tangent, bitangent);
  float radius = sqrt(u.x);
  float angle = 2.0 * pi * u.y;
  return normalize(tangent * (radius * cos(angle)) + bitangent * (radius * sin(angle)) +
                   normal * sqrt(max(0.0, 1.0 - u.x)));
}

/// A point of the unit disk, uniform.
vec2 sample_disk(vec2 u) {
  float radius = sqrt(u.x);
  float angle = 2.0 * pi * u.y;
  return radius * vec2(cos(angle), sin(angle));
}

#endif
