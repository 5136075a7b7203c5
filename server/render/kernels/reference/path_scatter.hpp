// Where paths go on from surfaces: scatter() of shaders/reference/reference_bounce.comp in vectors.
// Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_PATH_SCATTER_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_PATH_SCATTER_HPP
#undef HELIOGRAPH_KERNELS_PATH_SCATTER_HPP
#else
#define HELIOGRAPH_KERNELS_PATH_SCATTER_HPP
#endif

#include "render/kernels/reference/path_state.hpp"
#include "render/kernels/reference/reference.hpp"
#include "render/kernels/simd/material/scattering.hpp"
#include "render/kernels/simd/material/transmission.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// `Surface`: SurfaceLanes, or LayeredSurfaceLanes. References outlive it.
template <class Surface>
class PathScatter {
  using Material =
      std::conditional_t<Surface::layered, LayeredMaterial<Float>, SurfaceMaterial<Float>>;

 public:
  PathScatter(const ReferenceBounceJob& job, const PathNumbers& numbers)
      : scene_(job.lit_scene.scene), transmits_(job.transmits), numbers_(numbers) {}

  /// One of the lobes or the way through, in proportion to what it gives. `width`: of the paths'
  /// cones at the surfaces. @return the directions
  HWY_INLINE Float3 scatter(const Surface& s, const Material& m, const BoundaryLanes& boundary,
                            Float width, const PixelLanes& pixel, PathLanes& path) const {
    const LobeProbabilities lobes = lobe_probabilities(m);
    const Float2 u = numbers_.direction.at(pixel);
    const Float pick = numbers_.lobe.at(pixel);
    Onward onward = reflected(m, lobes, pick, u);
    if constexpr (Surface::layered) {
      if (transmits_) pass(s, m, boundary, lobes, pick, u, pixel, path, onward);
      if (scatters_through(m)) scatter_behind(m, boundary, lobes, pick, u, onward);
    }
    path.throughput = path.throughput * onward.weight;
    path.density = onward.density;
    const Integer turned = hn::IfThenElseZero(integer_mask(onward.turned),
                                              integer(static_cast<int>(shared::path_turned)));
    const Integer specular = hn::IfThenElseZero(integer_mask(onward.specular),
                                                integer(static_cast<int>(shared::path_specular)));
    const Integer before = hn::And(path.flags, integer(~static_cast<int>(shared::path_specular)));
    path.flags = hn::Or(before, hn::Or(turned, specular));
    path.cone_width = width;
    path.cone_spread =
        hn::MulAdd(number(0.5f) * onward.roughness, onward.roughness, path.cone_spread);
    path.bounces = path.bounces + hn::IfThenElseZero(onward.turned, one());
    return onward.direction;
  }

 private:
  struct Onward {
    Float3 direction, weight;
    Float density, roughness;
    Mask specular;
    Mask turned;  // not passed
  };

  /// By one of the two lobes.
  HWY_INLINE Onward reflected(const Material& m, const LobeProbabilities& lobes, Float pick,
                              const Float2& u) const {
    const SpecularSample drawn = sample_specular(m, u);
    const Float3 wide = sample_cosine(m.normal, u.x, u.y);
    const Mask open = hn::Gt(dot(wide, m.geometric), zero());
    const Float3 wide_share =
        keep(open, wide_weight(m, wide) * (one() / at_least(lobes.wide, 1e-6f)));
    const Float3 specular_share = drawn.weight * (one() / at_least(lobes.specular, 1e-30f));
    const Float by_chance =
        hn::IfThenElseZero(is_scattering(drawn.roughness), lobes.specular * drawn.density);
    const Float by_cosine = lobes.wide * cosine_density(at_least(dot(wide, m.normal), 0.0f));
    Onward to;
    to.specular = hn::Lt(pick, lobes.specular);
    to.turned = hn::Eq(pick, pick);
    to.direction = select(to.specular, drawn.direction, wide);
    to.weight = select(to.specular, specular_share, wide_share);
    to.density = select(to.specular, by_chance, by_cosine);
    to.roughness = select(to.specular, drawn.roughness, one());
    return to;
  }

  /// Of the paths that are scattered to the other side.
  HWY_INLINE void scatter_behind(const Material& m, const BoundaryLanes& boundary,
                                 const LobeProbabilities& lobes, Float pick, const Float2& u,
                                 Onward& onward) const {
    const Float first = lobes.specular + lobes.through;
    const Mask drawn = hn::And(hn::Ge(pick, first), hn::Lt(pick, first + lobes.behind));
    const Mask lanes = hn::AndNot(boundary.leaving, drawn);
    if (none(lanes)) return;
    const Float3 direction = sample_cosine(-m.normal, u.x, u.y);
    const Mask open = hn::Lt(dot(direction, m.geometric), zero());
    const Float3 share =
        keep(open, transmitted_albedo(m) * (one() / at_least(lobes.behind, 1e-6f)));
    const Float cosine = at_least(hn::Neg(dot(direction, m.normal)), 0.0f);
    onward.direction = select(lanes, direction, onward.direction);
    onward.weight = select(lanes, share, onward.weight);
    onward.density = select(lanes, lobes.behind * cosine_density(cosine), onward.density);
    onward.roughness = select(lanes, one(), onward.roughness);
    onward.specular = hn::AndNot(lanes, onward.specular);
    onward.turned = hn::Or(onward.turned, lanes);
  }

  /// Of the paths whose light passes the surface, or comes from within a volume.
  HWY_INLINE void pass(const Surface& s, const Material& m, const BoundaryLanes& boundary,
                       const LobeProbabilities& lobes, Float pick, const Float2& u,
                       const PixelLanes& pixel, PathLanes& path, Onward& onward) const {
    const Mask below = hn::Lt(pick, lobes.specular + lobes.through);
    const Mask through = hn::AndNot(hn::Or(onward.specular, boundary.leaving), below);
    const Mask concerned = hn::Or(through, boundary.leaving);
    if (none(concerned)) return;
    const Mask bent = hn::And(concerned, boundary.volume);
    const Integer medium = select(bent, boundary.medium, integer(0));
    if (!none(bent)) disperse(medium, pixel, path);
    const Float index = refraction_index(scene_, medium, path.band());
    const Float3 entered = sample_transmitted(m, index, u);
    const Float3 share = m.transmitted * (one() / at_least(lobes.through, 1e-30f));
    onward.direction = select(through, entered, onward.direction);
    onward.weight = select(through, share, onward.weight);
    onward.specular = hn::Or(onward.specular, through);
    onward.turned = hn::Not(through);
    Integer next = select(hn::And(through, bent), medium, path.medium());
    if (!none(boundary.leaving)) {
      const Mask leaving = boundary.leaving;
      const DepartureLanes d = sample_departure(s, m, index, pick, u);
      onward.direction = select(leaving, d.direction, onward.direction);
      onward.weight = select(leaving, d.weight, onward.weight);
      onward.specular =
          hn::Or(hn::AndNot(leaving, onward.specular), hn::AndNot(d.diffuse, leaving));
      onward.turned = hn::AndNot(hn::And(leaving, d.outside), onward.turned);
      next = select(leaving, select(d.outside, integer(0), medium), next);
    }
    onward.density = hn::IfThenZeroElse(concerned, onward.density);
    onward.roughness = select(concerned, m.roughness, onward.roughness);
    path.enter(next);
  }

  /// Chooses the band of wavelengths of paths where they first meet what bends them differently.
  HWY_INLINE void disperse(Integer medium, const PixelLanes& pixel, PathLanes& path) const {
    const Mask whole = float_mask(hn::Eq(path.band(), integer(0)));
    const Mask splits = hn::And(whole, hn::Gt(dispersion_of(scene_, medium), zero()));
    if (none(splits)) return;
    const Integer drawn = hn::Min(truncated(numbers_.band.at(pixel) * number(3.0f)), integer(2));
    const auto factor = [&](int band) HWY_ATTR {
      const Mask chosen = float_mask(hn::Eq(drawn, integer(band)));
      return select(splits, hn::IfThenElseZero(chosen, number(3.0f)), one());
    };
    path.throughput = path.throughput * Float3{factor(0), factor(1), factor(2)};
    const Integer bits = hn::ShiftLeft<shared::path_band_shift>(hn::Add(drawn, integer(1)));
    path.flags = hn::Or(path.flags, hn::IfThenElseZero(integer_mask(splits), bits));
  }

  const SceneView& scene_;
  bool transmits_;
  const PathNumbers& numbers_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
