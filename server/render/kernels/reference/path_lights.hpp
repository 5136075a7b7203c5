// Rays from the vertices of paths to lights, the sky and emissive triangles, which carry what
// arrives along them, in vectors. Included once per instruction set; the guard is Google Highway's
// convention.
#if defined(HELIOGRAPH_KERNELS_PATH_LIGHTS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_PATH_LIGHTS_HPP
#undef HELIOGRAPH_KERNELS_PATH_LIGHTS_HPP
#else
#define HELIOGRAPH_KERNELS_PATH_LIGHTS_HPP
#endif

#include <utility>

#include "render/kernels/gbuffer/gbuffer_shading.hpp"
#include "render/kernels/reference/path_state.hpp"
#include "render/kernels/reference/reference.hpp"
#include "render/kernels/simd/emissive_lights.hpp"
#include "render/kernels/simd/environment_cells.hpp"
#include "render/kernels/simd/lights.hpp"
#include "render/kernels/simd/material/scattering.hpp"
#include "render/kernels/simd/stored_triples.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Where paths are.
template <class Material>
struct Vertex {
  const Material& m;
  const Float3& position;
  const Float3& throughput;
  const PixelLanes& pixel;
};

/// A density per square metre of points as one per steradian of their directions, seen from `away`
/// metres under this cosine.
HWY_INLINE Float density_of_direction(Float density, Float away, Float cosine) {
  return density * away * away / at_least(hn::Abs(cosine), 1e-6f);
}

/// `Surface`: SurfaceLanes, or LayeredSurfaceLanes. References outlive it. All rays begin where
/// `from` does.
template <class Surface>
class PathLights {
  using Material =
      std::conditional_t<Surface::layered, LayeredMaterial<Float>, SurfaceMaterial<Float>>;
  using At = Vertex<Material>;

 public:
  PathLights(const ReferenceBounceJob& job, const EnvironmentLanes& environment,
             const EnvironmentCells& cells, const PathNumbers& numbers)
      : job_(job), environment_(environment), cells_(cells), numbers_(numbers) {}

  /// To a point of one light, drawn in proportion to what it sends to the eye.
  HWY_INLINE void add_light(const At& at, RayLanes from, Mask lit, RayBatch& to) const {
    const auto lights = job_.lit_scene.lights;
    const SquareTexels& ltc = job_.lit_scene.tables.ltc;
    Float pick = numbers_.light.at(at.pixel);
    LightChoice choice = choose_light(lights, ltc, at.m, at.position, lit, pick);
    const Mask valid = hn::And(lit, hn::Gt(choice.total, zero()));
    if (none(valid)) return;
    const Float2 u = numbers_.light_point.at(at.pixel);
    const bool areas = std::exchange(choice.areas, false);
    aim(lights, choice, at.m, at.position, u, pick, valid, from);
    if (areas) aim_at_areas(at, u, valid, choice, from);
    // The light's disk may reach below the horizon, where nothing of it is seen.
    const Mask seen = hn::Gt(dot(from.direction, lit_side(at.m, choice.direction)), zero());
    if ((job_.frame.flags & shared::frame_shadows) == 0) from.t_max = zero();
    from.user = at.throughput * choice.contribution * (choice.total / choice.weight);
    add_lit(at, from, hn::And(valid, seen), to);
  }

  /// Along a direction drawn from the environment's own table.
  HWY_INLINE void add_sky(const At& at, RayLanes from, Mask lanes, RayBatch& to) const {
    const EnvironmentSample sky =
        cells_.sample(numbers_.sky_cell.at(at.pixel), numbers_.sky_point.at(at.pixel));
    from.direction = sky.direction;
    from.t_max = number(1e30f);
    const Mask lit = hn::And(lanes, is_lit_from(at.m, sky.direction));
    if (none(lit)) return;
    const bool diffuse = (job_.frame.flags & shared::frame_environment_diffuse) != 0;
    const bool specular = (job_.frame.flags & shared::frame_environment_specular) != 0;
    from.user = at.throughput *
                scattered_light(at.m, sky.direction, sky.density, diffuse, specular) *
                environment_.radiance(sky.direction);
    add_lit(at, from, lit, to);
  }

  /// To a point of an emissive triangle, drawn by power. The cones of rays there have this width
  /// and spread.
  HWY_INLINE void add_emissive(const At& at, RayLanes from, Float width, Float spread, Mask lanes,
                               RayBatch& to) const {
    const SceneView& scene = job_.lit_scene.scene;
    const HitLanes drawn =
        draw_emissive(scene, numbers_.triangle.at(at.pixel), numbers_.triangle_point.at(at.pixel));
    const EmissiveLanes light = emissive_sample<false>(scene, drawn, at.position, width, spread);
    const Float3 way = light.position - at.position;
    const Float away = hn::Sqrt(dot(way, way));
    from.direction = way * (one() / at_least(away, 1e-20f));
    // As far as the triangle, which must not occlude itself.
    from.t_max = away * number(0.999f);
    const Float density =
        density_of_direction(light.density, away, dot(light.normal, from.direction));
    const Mask shines = hn::And(
        lanes, hn::And(hn::Gt(largest_of(light.emission), zero()), hn::Gt(density, zero())));
    if (none(shines)) return;
    from.user =
        at.throughput * light.emission * scattered_light(at.m, from.direction, density, true, true);
    add_lit(at, from, shines, to);
  }

  /// How likely add_emissive() finds what rays along `direction` have met, per steradian. 0: never.
  HWY_INLINE Float emissive_density(const Surface& s, const HitLanes& hit,
                                    const Float3& direction) const {
    const Mask shines = hn::And(hn::Gt(largest_of(s.emissive), zero()), hn::Gt(s.area, zero()));
    const Float share = emissive_probability(job_.lit_scene.scene, hit.instance, hit.triangle);
    const Float density = share / select(shines, s.area, one());
    return hn::IfThenElseZero(shines,
                              density_of_direction(density, hit.t, dot(s.front, direction)));
  }

 private:
  /// Where the choice is a light with an area: a point of it, and its light from there.
  HWY_INLINE void aim_at_areas(const At& at, const Float2& u, Mask valid, LightChoice& choice,
                               RayLanes& ray) const {
    const auto lights = job_.lit_scene.lights;
    for (std::size_t i = 0; i < lights.size(); ++i) {
      if (!has_area(lights[i])) continue;
      const Integer light_number = integer(static_cast<int>(i));
      const Mask chosen = hn::And(valid, float_mask(hn::Eq(choice.number, light_number)));
      if (none(chosen)) continue;
      const AreaSample<Float> s = sample_area(lights[i], at.position, u);
      const Float3 sent =
          numbers(lights[i].color) * s.solid_angle * shade_light_of_side(tag, at.m, s.direction);
      ray.direction = select(chosen, s.direction, ray.direction);
      choice.direction = select(chosen, s.direction, choice.direction);
      // Geometry may lie where an area light does and show it: it must not occlude itself.
      ray.t_max = select(chosen, s.distance * number(0.999f), ray.t_max);
      choice.contribution = select(chosen, sent, choice.contribution);
    }
  }

  /// Rays that carry anything and begin on a side of their triangle that light reaches.
  HWY_INLINE void add_lit(const At& at, RayLanes ray, Mask lanes, RayBatch& to) const {
    const Mask lit = is_lit_from(at.m, ray.direction);
    const Mask carries = hn::Gt(largest_of(ray.user), zero());
    if (scatters_through(at.m)) {
      ray.origin = offset_origin(at.position, lit_side(at.m, ray.direction), zero());
    }
    to.add(ray, hn::And(lanes, hn::And(lit, carries)));
  }

  const ReferenceBounceJob& job_;
  const EnvironmentLanes& environment_;
  const EnvironmentCells& cells_;
  const PathNumbers& numbers_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
