#include "render/kernels/compose.hpp"

#include <type_traits>

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/compose.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/environment.hpp"
#include "render/kernels/simd/light_grid.hpp"
#include "render/kernels/simd/material/packed_layer.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/view.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class D, bool layered>
class Composition {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using Unsigneds = hn::RebindToUnsigned<D>;
  using Material = std::conditional_t<layered, LayeredMaterial<V>, SurfaceMaterial<V>>;

  /// What each signal of a pixel is multiplied by, and what needs none.
  struct Terms {
    Triple<V> own;
    Triple<V> direct;
    Triple<V> ambient;
    Triple<V> specular;
    Triple<V> indirect;
    V sky;  // luminance of the latter if nothing hid the environment, where `ambient` shows it
  };
  /// The signals that they are multiplied by.
  struct Signals {
    V shadow;
    V ambient;
    Triple<V> specular;
    Triple<V> indirect;
  };

 public:
  HWY_INLINE explicit Composition(const ComposeJob& job)
      : job_(job),
        tables_(job.tables),
        environment_(job.frame, job.environment),
        light_picks_({}, job.frame.sample_index, shared::light_picks_dimension, job.frame.seed) {}

  HWY_INLINE void rows(int first, int last) {
    std::vector<shared::Light> found;
    const int lanes = static_cast<int>(hn::Lanes(d_));
    const int step = job_.outside.culls() ? std::max(lanes, 64) : job_.width;
    for (int left = 0; left < job_.width; left += step) {
      const int right = std::min(left + step, job_.width);
      lights_ = job_.outside.of({std::min(left, job_.width - lanes), first, right, last},
                                job_.motion, found);
      for (int y = first; y < last; ++y) {
        const ViewedRow<D> view(job_.frame, y);
        for (int x = left; x < right; x += lanes) block(view, std::min(x, job_.width - lanes), y);
      }
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }
  HWY_INLINE Triple<V> black() const { return {hn::Zero(d_), hn::Zero(d_), hn::Zero(d_)}; }
  HWY_INLINE bool enabled(std::uint32_t flag) const { return (job_.frame.flags & flag) != 0; }
  HWY_INLINE Quad<V> load(const gpu::HostView& image, int x, int y) const {
    return load4(d_, row_of<const float>(image, y) + 4 * x);
  }
  HWY_INLINE V load_one(const gpu::HostView& image, int x, int y) const {
    return hn::LoadU(d_, row_of<const float>(image, y) + x);
  }
  HWY_INLINE Triple<V> color(const gpu::HostView& image, int x, int y) const {
    const Quad<V> t = load(image, x, y);
    return {t.x, t.y, t.z};
  }

  HWY_INLINE void block(const ViewedRow<D>& view, int x, int y) const {
    const V view_z = load(job_.motion, x, y).w;
    const M seen = hn::Gt(view_z, hn::Zero(d_));
    Terms terms{black(), black(), black(), black(), black(), hn::Zero(d_)};
    if (!hn::AllFalse(d_, seen)) add_surface(view, x, y, view_z, seen, terms);
    if (!hn::AllTrue(d_, seen)) {
      terms.own = select(seen, terms.own, color(job_.background, x, y));
    }
    if (!job_.denoised_visibility) {
      store(terms, noisy(x, y, black()), job_.hdr, x, y);
      return;
    }
    const Signals smooth = denoised(x, y);
    store(terms, smooth, job_.hdr, x, y);
    if (job_.constants.makes_noisy == 0) return;
    store(terms, noisy(x, y, smooth.indirect), job_.hdr_noisy, x, y);
  }

  HWY_INLINE bool reflects() const { return job_.constants.max_roughness >= 0.0f; }

  HWY_INLINE Signals denoised(int x, int y) const {
    const Quad<V> visibility = load(job_.denoised_visibility, x, y);
    const bool gathers = enabled(shared::frame_indirect);
    return {visibility.x, visibility.y, reflects() ? color(job_.denoised_specular, x, y) : black(),
            gathers ? color(job_.denoised_indirect, x, y) : black()};
  }

  /// `smooth_indirect`: where there is no sample.
  HWY_INLINE Signals noisy(int x, int y, const Triple<V>& smooth_indirect) const {
    Signals made{load_one(job_.shadows, x, y), load_one(job_.ambient, x, y),
                 reflects() ? color(job_.specular, x, y) : black(), smooth_indirect};
    if (enabled(shared::frame_indirect)) {
      const Quad<V> indirect = load(job_.indirect, x, y);
      const M sampled = hn::Ge(indirect.w, hn::Zero(d_));
      made.indirect = select(sampled, {indirect.x, indirect.y, indirect.z}, smooth_indirect);
    }
    return made;
  }

  HWY_INLINE void add_surface(const ViewedRow<D>& view, int x, int y, V view_z, M seen,
                              Terms& terms) const {
    const Quad<V> root = load_unorm8(d_, row_of<const std::uint32_t>(job_.base_color, y) + x);
    const Quad<V> packed = load_unorm8(d_, row_of<const std::uint32_t>(job_.surface, y) + x);
    const Triple<V> base_color{root.x * root.x, root.y * root.y, root.z * root.z};
    const M unlit = hn::And(seen, hn::Gt(packed.z, set(0.5f)));
    const M lit = hn::AndNot(unlit, seen);
    if (!hn::AllFalse(d_, lit)) {
      const Material m = material(view, x, y, base_color, packed);
      if (enabled(shared::frame_direct)) {
        terms.direct = direct(view.world_position(x, view_z), x, y, lit, m);
      }
      add_lit(lit, m, root.w, terms);
    }
    terms.own = select(unlit, base_color, terms.own);
    if (enabled(shared::frame_emissive)) {
      const auto* emissive = row_of<const std::uint32_t>(job_.emissive, y) + 2 * x;
      terms.own = select(seen, terms.own + load_half3(d_, emissive), terms.own);
    }
  }

  HWY_INLINE Material material(const ViewedRow<D>& view, int x, int y, const Triple<V>& base_color,
                               const Quad<V>& packed) const {
    const Quad<V> encoded = load(job_.normals, x, y);
    const Triple<V> normal = octahedral_decode(encoded.x, encoded.y);
    const Triple<V> geometric = octahedral_decode(encoded.z, encoded.w);
    if constexpr (layered) {
      V roughness;
      const SurfaceLayer<V> layer =
          unpack_layer(d_, load(job_.layers, x, y), normal, packed.w, roughness);
      return make_material(d_, base_color, packed.y, roughness, normal, geometric, view.to_eye(x),
                           tables_, layer);
    } else {
      return make_material(d_, base_color, packed.y, packed.x, normal, geometric, view.to_eye(x),
                           tables_.split_sum);
    }
  }

  HWY_INLINE Triple<V> direct(const Triple<V>& position, int x, int y, M lit,
                              const Material& m) const {
    const Triple<V> outside = direct_light(d_, lights_, job_.tables.ltc, m, position, lit);
    if (!job_.lights.grid) return outside;
    const V picks = light_picks_.at(hn::Iota(Unsigneds(), static_cast<std::uint32_t>(x)),
                                    hn::Set(Unsigneds(), static_cast<std::uint32_t>(y)));
    return outside + cell_light(d_, job_.lights, m, position, lit, picks);
  }

  HWY_INLINE void add_lit(M lit, const Material& m, V occlusion, Terms& terms) const {
    if (enabled(shared::frame_indirect)) {
      terms.indirect = select(lit, spread_albedo(m), terms.indirect);
    } else if (enabled(shared::frame_environment_diffuse)) {
      terms.ambient = select(lit, open_diffuse(m) * occlusion, terms.ambient);
    }
    // Roughness is stored in steps of 1 / 255: a little more than half of one is still the same.
    const M traced = hn::And(
        lit, hn::Le(narrower_roughness(m), set(job_.constants.max_roughness + 0.6f / 255.0f)));
    terms.specular = select(traced, m.specular_albedo, terms.specular);
    const M looked_up = hn::AndNot(traced, lit);
    if (enabled(shared::frame_environment_specular) && !hn::AllFalse(d_, looked_up)) {
      const Triple<V> light =
          environment_specular(m, [&](const Triple<V>& normal, V roughness)
                                      HWY_ATTR { return reflection(normal, m.eye, roughness); });
      terms.ambient = select(looked_up, terms.ambient + light * occlusion, terms.ambient);
      if (enabled(shared::frame_indirect)) {
        terms.sky = hn::IfThenElseZero(looked_up, luminance(open_indirect(m)));
      }
    }
  }

  HWY_INLINE Triple<V> open_diffuse(const Material& m) const {
    return environment_diffuse(
        m, [&](const Triple<V>& normal) HWY_ATTR { return irradiance(normal); });
  }

  /// What the indirect signal is where nothing hides the environment.
  HWY_INLINE Triple<V> open_indirect(const Material& m) const {
    const Triple<V> one_side = irradiance(m.normal);
    if (!scatters_through(m)) return one_side;
    const Triple<V> light = open_diffuse(m), albedo = spread_albedo(m);
    const V least = set(1e-6f);
    const Triple<V> both{light.x / hn::Max(albedo.x, least), light.y / hn::Max(albedo.y, least),
                         light.z / hn::Max(albedo.z, least)};
    const M through = hn::Gt(largest_of(transmitted_albedo(m)), hn::Zero(d_));
    return select(through, both, one_side);
  }

  /// environment_reflection() of shaders/lib/lighting/environment.glsl
  HWY_INLINE Triple<V> reflection(const Triple<V>& normal, const Triple<V>& eye,
                                  V roughness) const {
    const V twice = dot(normal, eye) * set(2.0f);
    const Triple<V> toward{hn::MulSub(normal.x, twice, eye.x), hn::MulSub(normal.y, twice, eye.y),
                           hn::MulSub(normal.z, twice, eye.z)};
    if constexpr (std::is_same_v<D, Tag>) {
      return environment_.reflection(toward, roughness);
    } else {
      // One pixel: in all lanes.
      const auto lanes = [](V value) HWY_ATTR { return number(hn::GetLane(value)); };
      const Float3 found = environment_.reflection(
          {lanes(toward.x), lanes(toward.y), lanes(toward.z)}, lanes(roughness));
      return {set(hn::GetLane(found.x)), set(hn::GetLane(found.y)), set(hn::GetLane(found.z))};
    }
  }

  /// environment_irradiance() of shaders/lib/lighting/environment.glsl
  HWY_INLINE Triple<V> irradiance(const Triple<V>& world) const {
    const V c = set(job_.frame.environment_cos), s = set(job_.frame.environment_sin);
    const V x = hn::MulSub(c, world.x, s * world.z);
    const V y = world.y;
    const V z = hn::MulAdd(s, world.x, c * world.z);
    const auto term = [this](int i)
                          HWY_ATTR { return splat(d_, glm::vec3(job_.frame.irradiance[i])); };
    Triple<V> sum = term(0) + term(1) * y + term(2) * z + term(3) * x;
    sum = sum + term(4) * (x * y) + term(5) * (y * z);
    sum = sum + term(6) * hn::MulSub(set(3.0f) * z, z, set(1.0f)) + term(7) * (x * z);
    sum = sum + term(8) * hn::MulSub(x, x, y * y);
    const V zero = hn::Zero(d_);
    return Triple<V>{hn::Max(sum.x, zero), hn::Max(sum.y, zero), hn::Max(sum.z, zero)} *
           set(job_.frame.environment_intensity);
  }

  HWY_INLINE void store(const Terms& terms, const Signals& signals, const gpu::HostView& to, int x,
                        int y) const {
    const V one = set(1.0f);
    const V lit = enabled(shared::frame_shadows) ? signals.shadow : one;
    V open = shared::traces_ambient(job_.frame.flags) ? signals.ambient : one;
    if (enabled(shared::frame_indirect)) {
      const V share = luminance(signals.indirect) / hn::Max(terms.sky, set(1e-30f));
      open = hn::IfThenElse(hn::Gt(terms.sky, hn::Zero(d_)), hn::Min(share, one), open);
    }
    Triple<V> radiance = terms.own + terms.direct * lit + terms.ambient * open +
                         terms.specular * signals.specular + terms.indirect * signals.indirect;
    // One bad pixel must not spread through the history.
    radiance = select(is_bad(radiance), black(), radiance);
    store4(d_, {radiance.x, radiance.y, radiance.z, one}, row_of<float>(to, y) + 4 * x);
  }

  const D d_{};
  const ComposeJob& job_;
  LobeLanes<D> tables_;
  EnvironmentLanes environment_;
  RandomNumbers<Unsigneds> light_picks_;
  std::span<const shared::Light> lights_;  // outside of the grid that may reach the pixels
};

template <class D>
using PlainComposition = Composition<D, false>;
template <class D>
using LayeredComposition = Composition<D, true>;

void compose_rows(const ComposeJob& job, int first, int last) {
  if (job.layered) return run_rows<LayeredComposition>(job, job.width, first, last);
  run_rows<PlainComposition>(job, job.width, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(compose_rows);

void compose(const ComposeJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(compose_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
