#include "render/kernels/ground/ground_factor.hpp"
#include "render/kernels/reference/reference.hpp"
#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/reference/reference_bounce.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/reference/path_lights.hpp"
#include "render/kernels/reference/path_scatter.hpp"
#include "render/kernels/reference/path_state.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

struct BounceBatches {
  RayBatch next, shadows, sky, emissive;
};

/// One vertex of paths: bounce() of the shader. `Surface`: SurfaceLanes, or LayeredSurfaceLanes.
template <class Surface>
class PathVertices {
  using Material =
      std::conditional_t<Surface::layered, LayeredMaterial<Float>, SurfaceMaterial<Float>>;

 public:
  explicit PathVertices(const ReferenceBounceJob& job)
      : job_(job),
        tables_(job.lit_scene.tables),
        environment_(job.frame, job.lit_scene.environment),
        cells_(job.frame, job.cells),
        numbers_(job.frame, job.constants.round),
        lights_(job, environment_, cells_, numbers_),
        scatter_(job, numbers_) {}

  void block(int first, int last, BounceBatches& to) const {
    const RayLanes ray = load_rays(job_.rays.rays, first, last);
    const Mask inside = float_mask(hn::Lt(hn::Iota(integer_tag, first), integer(last)));
    const Mask requested = hn::And(inside, hn::Lt(ray.t_min, ray.t_max));
    if (none(requested)) return;
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    HitLanes hit = load_hits(job_.hits, first, last);
    hit.met = hn::And(hit.met, requested);
    PathLanes path = job_.constants.round == 0 ? first_paths(job_.frame)
                                               : load_paths(job_.paths, path_index(pixel));
    const Mask missed = hn::AndNot(hit.met, requested);
    Float3 radiance = numbers(0.0f);
    if (!none(missed)) radiance = keep(missed, path.throughput * at_miss(path, ray, missed));
    if (!none(hit.met)) {
      radiance = radiance + keep(hit.met, at_hit(ray, hit, pixel, path, to));
    }
    add(radiance, pixel, requested);
  }

 private:
  Integer path_index(const PixelLanes& pixel) const {
    const auto first = static_cast<int>(job_.frame.extent.x) * job_.rows.top;
    return hn::Sub(pixel_index(job_.frame, pixel), integer(first));
  }

  bool enabled(std::uint32_t flag) const { return (job_.frame.flags & flag) != 0; }

  HWY_INLINE Float3 at_miss(const PathLanes& path, const RayLanes& ray, Mask missed) const {
    const Mask seen = hn::And(missed, path.is_seen());
    Float3 light = numbers(0.0f);
    if (!none(seen)) light = background(ray, seen);
    if (all(hn::Or(seen, hn::Not(missed)))) return light;
    const auto bright = [this](std::uint32_t flag) { return number(enabled(flag) ? 1.0f : 0.0f); };
    const Float lit = select(path.left_by_specular(), bright(shared::frame_environment_specular),
                             bright(shared::frame_environment_diffuse));
    const Float other =
        hn::IfThenElseZero(hn::Gt(path.density, zero()), cells_.density(ray.direction));
    const Float3 sky =
        environment_.radiance(ray.direction) * hn::Mul(lit, mis_weight(path.density, other));
    return select(seen, light, sky);
  }

  /// What the camera sees where nothing is.
  HWY_INLINE Float3 background(const RayLanes& ray, Mask seen) const {
    if (!enabled(shared::frame_environment_visible)) return numbers(0.0f);
    const Float3 light =
        radiance_from(job_.background, job_.frame, ray.direction, job_.frame.background_intensity);
    if (job_.frame.ground.w <= 0.0f) return light;
    const StoredTriples origins(ray.origin), directions(ray.direction);
    HWY_ALIGN std::array<float, hn::MaxLanes(Tag())> factors{};
    for_each_lane(seen, [&](std::size_t lane) {
      factors[lane] = ground_factor(job_.frame.ground, job_.ground_shade, origins.at(lane),
                                    directions.at(lane));
    });
    return light * hn::Load(tag, factors.data());
  }

  /// Makes the rays that leave and stores their paths. @return the radiance that the eye sees
  HWY_INLINE Float3 at_hit(RayLanes ray, const HitLanes& hit, const PixelLanes& pixel,
                           PathLanes& path, BounceBatches& to) const {
    const Float width = hn::MulAdd(path.cone_spread, hit.t, path.cone_width);
    auto s = hit_surface<Surface, false>(job_.lit_scene.scene, hit, ray.direction, width);
    if constexpr (Surface::layered) {
      // What a volume lets in is attenuated along the way through it, not at its surface.
      const Float whole = s.layer.transmission;
      s.layer.transmitted = {whole, whole, whole};
      attenuate(ray, hit, path);
    }
    const Material m = material_of(s, ray.direction, tables_);
    Mask passes = hn::And(path.is_seen(), is_open(s, ray.direction));
    passes = hn::And(hn::And(hit.met, passes), float_mask(hn::Eq(path.medium(), integer(0))));
    BoundaryLanes boundary = boundary_of(job_.lit_scene.scene, hit, s, ray.direction);
    // The camera is in no volume: whichever side it sees, it sees from outside.
    boundary.leaving = hn::AndNot(path.is_camera_ray(), boundary.leaving);
    const Mask caught = hn::And(boundary.leaving, hn::Not(may_scatter(path)));
    if (!none(caught)) {
      // Volumes keep no light of paths that end.
      path.enter(select(caught, integer(0), path.medium()));
      passes = hn::Or(passes, caught);
    }
    const Mask blended = hn::AndNot(passes, hn::And(hit.met, is_blended(s)));
    if (!none(blended)) passes = hn::Or(passes, pass_through(s, pixel, blended, path));
    if (!none(passes)) {
      RayLanes beyond = ray;
      beyond.t_min = GBufferShading<Surface>::passed_from(hit.t);
      go_on(beyond, path, pixel, passes, to.next);
    }
    const Mask stays = hn::AndNot(passes, hit.met);
    if (none(stays)) return numbers(0.0f);
    const Mask unlit = s.has(shared::material_unlit);
    const Float3 own = own_light(path, s, hit, ray.direction, unlit) * path.throughput;
    const Mask lit = hn::AndNot(unlit, stays);
    if (!none(lit)) {
      ray.origin = offset_origin(s.position, s.geometric, zero());
      ray.t_min = zero();
      leave(ray, boundary, s, m, width, pixel, lit, path, to);
    }
    return keep(stays, own);
  }

  HWY_INLINE Mask may_scatter(const PathLanes& path) const {
    return hn::Lt(path.bounces, number(static_cast<float>(job_.constants.limit)));
  }

  /// By the volume that the rays have come through.
  HWY_INLINE void attenuate(const RayLanes& ray, const HitLanes& hit, PathLanes& path) const {
    const Integer medium = path.medium();
    const Mask inside = hn::And(hit.met, float_mask(hn::Gt(medium, integer(0))));
    if (none(inside)) return;
    const Float3 left =
        left_by_volume(job_.lit_scene.scene, select(inside, medium, integer(0)), hit.t - ray.t_min);
    path.throughput = select(inside, path.throughput * left, path.throughput);
  }

  /// Lanes whose paths go straight on through a blended surface. Their throughput becomes that of
  /// the way they take.
  HWY_INLINE Mask pass_through(const Surface& s, const PixelLanes& pixel, Mask blended,
                               PathLanes& path) const {
    const Float behind = one() - s.alpha;
    const Mask passes = hn::And(blended, hn::Lt(numbers_.passing.at(pixel), behind));
    const Float by_way = select(passes, behind / at_least(behind, 1e-30f),
                                s.alpha / at_least(one() - behind, 1e-30f));
    path.throughput = select(blended, path.throughput * by_way, path.throughput);
    if (job_.transmits) path.density = hn::IfThenZeroElse(passes, path.density);
    return passes;
  }

  /// What surfaces send out by themselves.
  HWY_INLINE Float3 own_light(const PathLanes& path, const Surface& s, const HitLanes& hit,
                              const Float3& direction, Mask unlit) const {
    Float3 light = keep(unlit, s.base_color);
    if (!enabled(shared::frame_emissive)) return light;
    const Mask front = hn::Le(dot(s.front, direction), zero());
    const Mask shines = hn::Or(unlit, hn::Or(front, s.has(shared::material_double_sided)));
    const Float3 emission = keep(shines, s.emissive);
    if (none(hn::Gt(largest_of(emission), zero()))) return light;
    Float weight = one();
    if (job_.samples_emissive) {
      const Mask sampled = hn::AndNot(unlit, hn::Gt(path.density, zero()));
      weight = select(sampled,
                      mis_weight(path.density, lights_.emissive_density(s, hit, direction)), one());
    }
    return light + emission * weight;
  }

  /// The rays from lit surfaces. `ray`: their origins, and the directions that they come from.
  /// `width`: of the cones there.
  HWY_INLINE void leave(RayLanes ray, const BoundaryLanes& boundary, const Surface& s,
                        const Material& m, Float width, const PixelLanes& pixel, Mask lit,
                        PathLanes& path, BounceBatches& to) const {
    const Float3 arrived = path.throughput;
    if (enabled(shared::frame_direct)) {
      const Material outer = lit_from_outside(m, boundary.leaving);
      lights_.add_light({outer, s.position, arrived, pixel}, ray, lit, to.shadows);
    }
    const Mask goes_on = hn::And(lit, may_scatter(path));
    if (none(goes_on)) return;
    const Vertex<Material> vertex{m, s.position, arrived, pixel};
    const Mask samples = hn::AndNot(boundary.leaving, goes_on);
    lights_.add_sky(vertex, ray, samples, to.sky);
    if (job_.samples_emissive && enabled(shared::frame_emissive)) {
      const Float spread = path.cone_spread + number(0.5f);
      lights_.add_emissive(vertex, ray, width, spread, samples, to.emissive);
    }
    ray.direction = scatter_.scatter(s, m, boundary, width, pixel, path);
    if (job_.transmits || scatters_through(m)) {
      const Mask behind = hn::Lt(dot(ray.direction, s.geometric), zero());
      ray.origin = select(behind, offset_origin(s.position, -s.geometric, zero()), ray.origin);
    }
    ray.t_max = number(1e30f);
    go_on(ray, path, pixel, hn::And(goes_on, survives(pixel, path)), to.next);
  }

  /// What lights from outside do at boundaries that they reach through the volume: nothing but its
  /// diffuse lobe.
  static HWY_INLINE Material lit_from_outside(Material m, Mask leaving) {
    if constexpr (Surface::layered) {
      if (none(leaving)) return m;
      const Mask others = hn::Not(leaving);
      for (Float3* const part : {&m.f0, &m.f90_minus_f0, &m.specular_albedo, &m.diffuse_transmitted,
                                 &m.sheen, &m.sheen_albedo}) {
        *part = keep(others, *part);
      }
      m.coat_f0 = hn::IfThenElseZero(others, m.coat_f0);
      m.coat_f90_minus_f0 = hn::IfThenElseZero(others, m.coat_f90_minus_f0);
      m.coat_albedo = hn::IfThenElseZero(others, m.coat_albedo);
    }
    return m;
  }

  HWY_INLINE void go_on(const RayLanes& ray, const PathLanes& path, const PixelLanes& pixel,
                        Mask lanes, RayBatch& next) const {
    store_paths(path, lanes, path_index(pixel), job_.paths);
    next.add(ray, lanes);
  }

  /// Lanes whose paths carry any light and do not end at random (roulette) because they carry
  /// little.
  HWY_INLINE Mask survives(const PixelLanes& pixel, PathLanes& path) const {
    constexpr float first_roulette = 3.0f;  // bounce after which dim paths may end
    const Float largest = largest_of(path.throughput);
    Mask stays = hn::Gt(largest, zero());
    const Mask dim = hn::Ge(path.bounces, number(first_roulette));
    if (none(dim)) return stays;
    const Float survival = hn::Min(largest, number(0.95f));
    stays = hn::AndNot(hn::And(dim, hn::Ge(numbers_.survival.at(pixel), survival)), stays);
    const Float by_survival = one() / at_least(survival, 1e-30f);
    path.throughput = path.throughput * select(dim, by_survival, one());
    return stays;
  }

  HWY_INLINE void add(const Float3& radiance, const PixelLanes& pixel, Mask requested) const {
    const Float4 before = gathered4(job_.radiance, pixel);
    const Float3 sum =
        Float3{before.x, before.y, before.z} + select(is_bad(radiance), numbers(0.0f), radiance);
    const Texels<4> texels(Float4{sum.x, sum.y, sum.z, one()});
    const TexelIndices at(pixel);
    for_each_lane(requested, [&](std::size_t lane) { texels.put(job_.radiance, lane, at); });
  }

  const ReferenceBounceJob& job_;
  LobeLanes<Tag> tables_;
  EnvironmentLanes environment_;
  EnvironmentCells cells_;
  PathNumbers numbers_;
  PathLights<Surface> lights_;
  PathScatter<Surface> scatter_;
};

template <class Surface>
HWY_INLINE void bounce_batch_of(const ReferenceBounceJob& job, int first, int last) {
  const PathVertices<Surface> vertices(job);
  BounceBatches made;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    vertices.block(i, last, made);
  }
  made.next.append_to(job.next);
  made.shadows.append_to(job.shadows);
  made.sky.append_to(job.sky);
  made.emissive.append_to(job.emissive);
}

void bounce_batch(const ReferenceBounceJob& job, int first, int last) {
  if (job.lit_scene.layered) return bounce_batch_of<LayeredSurfaceLanes>(job, first, last);
  bounce_batch_of<SurfaceLanes>(job, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(bounce_batch);

void reference_begin(const gpu::HostPass<ReferenceBeginBindings>& job) {
  for_each_range(job.height, 16, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      std::fill_n(job.radiance.row<glm::vec4>(static_cast<std::uint32_t>(y)), job.width,
                  glm::vec4(0.0f));
    }
  });
}

void reference_bounce(const ReferenceBounceJob& job) {
  // Blended surfaces stop rays that could meet what they look for on a refracted way, too.
  const std::uint32_t by_chance = job.transmits ? 0 : job.blending;
  *job.shadows.count = full_count(0, job.blending);
  for (const auto* const lights : {&job.sky, &job.emissive}) {
    *lights->count = full_count(0, by_chance);
  }
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(bounce_batch)(job, first, last);
  });
  for (const auto* const made : {&job.next, &job.shadows, &job.sky, &job.emissive}) made->end();
}

}  // namespace heliograph::render::kernels
#endif
