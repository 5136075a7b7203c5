// Light from polygons by linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt 2016): the
// specular lobe is a clamped cosine whose directions a matrix moved; moved back by the inverse, a
// polygon is lit like a diffuse surface, whose light is an integral along its edges (Lambert 1760).
#ifndef HELIOGRAPH_LTC_GLSL
#define HELIOGRAPH_LTC_GLSL
#include "lib/math/geometry.glsl"

const float least_ltc_roughness = 0.03;  // narrower lobes than the table can hold

/// What runs along a convex polygon's edges, corner by corner, above the horizon z = 0.
struct Contour {
  float sum;
  vec3 leaves;   // where the outline goes below the horizon
  vec3 returns;  // and where it comes back
  bool cut;
};

Contour empty_contour() { return Contour(0.0, vec3(1.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), false); }

/// The angle between unit vectors times the z of the axis that turns `a` into `b`.
float edge_integral(vec3 a, vec3 b) {
  vec3 axis = cross(a, b);
  float sine = length(axis);
  return sine > 1e-7 ? axis.z * atan(sine, dot(a, b)) / sine : axis.z;
}

void add_edge(inout Contour contour, vec3 from, vec3 to) {
  if (from.z <= 0.0 && to.z <= 0.0) return;
  if (from.z < 0.0 || to.z < 0.0) {
    vec3 horizon = vec3(from.xy * to.z - to.xy * from.z, 0.0) / (to.z - from.z);
    contour.cut = true;
    if (to.z < 0.0) {
      to = horizon;
      contour.leaves = normalize(horizon);
    } else {
      from = horizon;
      contour.returns = normalize(horizon);
    }
  }
  contour.sum += edge_integral(normalize(from), normalize(to));
}

/// Fraction of the clamped cosine about +z that the polygon covers.
float covered_cosine(Contour contour) {
  // A convex polygon crosses the horizon twice at most: the edge along it closes the outline.
  if (contour.cut) contour.sum += edge_integral(contour.leaves, contour.returns);
  return clamp(abs(contour.sum) / (2.0 * pi), 0.0, 1.0);
}

/// The inverse matrix at entry (sqrt(1 - n.v), roughness) of the table.
mat3 ltc_inverse(sampler2D table, float n_dot_v, float roughness) {
  float size = float(textureSize(table, 0).x);
  vec2 at = vec2(sqrt(1.0 - n_dot_v), max(roughness, least_ltc_roughness));
  vec4 entry = textureLod(table, (at * (size - 1.0) + 0.5) / size, 0.0);
  return mat3(vec3(entry.x, 0.0, entry.y), vec3(0.0, 1.0, 0.0), vec3(entry.z, 0.0, entry.w));
}

/// Fraction of the lobe above the horizon, where it is cut off and made as bright again as it was
/// whole: the cosine over the lune between the hemisphere and the horizon's, moved back by the
/// matrix.
float ltc_share_above(mat3 inverse_lobe) {
  vec2 up = vec2(-inverse_lobe[0].z, inverse_lobe[0].x);
  return 0.5 + 0.5 * up.y / length(up);
}

/// World -> the frame of the table: z is the normal, the eye lies over +x.
mat3 shading_frame(vec3 normal, vec3 eye) {
  vec3 x = eye - normal * dot(eye, normal);
  vec3 y;
  if (dot(x, x) < 1e-8) {
    orthonormal_basis(normal, x, y);
  } else {
    x = normalize(x);
    y = cross(normal, x);
  }
  return transpose(mat3(x, y, normal));
}

#endif
