#include "render/kernels/sampling/sampling_plan.hpp"

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/sampling/sampling_plan.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/history.hpp"
#include "render/kernels/simd/random.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class D>
class Planning {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using DI = hn::RebindToSigned<D>;
  using DU = hn::RebindToUnsigned<D>;
  using VI = hn::Vec<DI>;
  using MI = hn::Mask<DI>;

 public:
  HWY_INLINE explicit Planning(const SamplingPlanJob& job)
      : job_(job),
        bounds_(job.width, job.height),
        half_bounds_((job.width + 1) / 2, (job.height + 1) / 2),
        turn_(static_cast<int>(job.frame.sample_index * shared::plan_step >> 29u)),
        fine_turn_(static_cast<int>(job.frame.sample_index * shared::plan_step >> 28u)),
        fades_({}, job.frame.sample_index, 7, job.frame.seed) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < job_.width; x += lanes) block(std::min(x, job_.width - lanes), y);
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }
  HWY_INLINE VI whole(int value) const { return hn::Set(di_, value); }

  /// turn_of() of the shader, advanced to this frame and by `ahead`.
  HWY_INLINE VI turn(int x, int y, int ahead) const {
    const VI column = hn::Iota(di_, x), one = whole(1);
    const VI differ = hn::Xor(column, whole(y));
    const VI place = hn::Or(
        hn::ShiftLeft<2>(hn::And(differ, one)),
        hn::Or(hn::ShiftLeft<1>(hn::And(column, one)), hn::And(hn::ShiftRight<1>(differ), one)));
    return hn::And(place + whole(turn_ + ahead), whole(shared::plan_turns - 1));
  }

  HWY_INLINE MI has_turn(VI turn, VI frames) const {
    return hn::Lt(hn::Mul(turn, frames), whole(shared::plan_turns));
  }

  /// fine_turn() of the shader, advanced to this frame.
  HWY_INLINE MI has_fine_turn(int x, int y, std::uint32_t frames) const {
    const VI column = hn::Iota(di_, x);
    const VI last = hn::And(hn::Xor(hn::ShiftRight<1>(column), whole(y >> 2)), whole(1));
    const VI place = hn::ShiftLeft<1>(turn(x, y, -turn_)) + last;
    const auto turns = static_cast<int>(2 * shared::plan_turns);
    const VI now = hn::And(place + whole(fine_turn_), whole(turns - 1));
    return hn::Lt(hn::Mul(now, whole(static_cast<int>(frames))), whole(turns));
  }

  HWY_INLINE MI has_ambient_turn(int x, int y, VI turn, std::uint32_t frames) const {
    if (job_.constants.indirect_side != 0) return has_fine_turn(x, y, frames);
    return has_turn(turn, whole(static_cast<int>(frames)));
  }

  HWY_INLINE MI is_sampled(V frames, VI most, VI turn) const {
    const M full = hn::Lt(frames, set(job_.constants.full_frames));
    return hn::Or(hn::RebindMask(di_, full), has_turn(turn, most));
  }

  /// A history counts for more where single samples hardly differ.
  HWY_INLINE V counted(V frames, V variance) const {
    const M quiet = hn::Lt(variance * frames, set(shared::plan_quiet_variance));
    return hn::IfThenElse(quiet, frames * set(shared::plan_quiet_factor), frames);
  }

  HWY_INLINE V indirect_frames(V x, V y) const {
    const bool half = job_.constants.indirect_side == 2;
    const VI column = hn::ConvertTo(di_, x), row = hn::ConvertTo(di_, y);
    const TexelGather<D> texels =
        half ? half_bounds_.gather(hn::ShiftRight<1>(column), hn::ShiftRight<1>(row))
             : bounds_.gather(column, row);
    return texels.template half_of_four_halves<0>(job_.indirect_length).x *
           set(shared::indirect_frames_factor);
  }

  /// is_faded() of the shader.
  HWY_INLINE MI is_faded(V roughness, V metallic, int x, int y) const {
    const auto& c = job_.constants;
    const V one = set(1.0f);
    const V rough = clamped((roughness - set(c.fade_start)) * set(c.fade_slope), 0.0f, 1.0f);
    const V fraction = rough * set(c.fade_fraction) * (one - metallic);
    if (hn::AllTrue(d_, hn::Le(fraction, hn::Zero(d_)))) return hn::FirstN(di_, 0);
    const DU du;
    const V number = fades_.at(hn::Iota(du, static_cast<shared::uint>(x)),
                               hn::Set(du, static_cast<shared::uint>(y)));
    return hn::RebindMask(di_, hn::Lt(number, fraction));
  }

  HWY_INLINE void block(int x, int y) const {
    const auto& c = job_.constants;
    const Quad<V> map = load4(d_, row_of<const float>(job_.reprojection, y) + 4 * x);
    const V half = set(0.5f), limit = set(1e6f);
    const V at_x = hn::Max(hn::Min(map.x, limit), hn::Neg(limit));
    const V at_y = hn::Max(hn::Min(map.y, limit), hn::Neg(limit));
    const V before_x = hn::Floor(at_x), before_y = hn::Floor(at_y);
    // The bit of the tap that the position lies in: 1, 2, 4 or 8.
    const V right = before_x - hn::Floor(at_x - half), down = before_y - hn::Floor(at_y - half);
    const V bit = (set(1.0f) + right) * hn::MulAdd(set(3.0f), down, set(1.0f));
    const VI valid = hn::And(hn::ConvertTo(di_, map.z), hn::ConvertTo(di_, bit));
    const MI known = hn::Ne(valid, whole(0));

    const TexelGather<D> texels =
        bounds_.gather(hn::ConvertTo(di_, before_x), hn::ConvertTo(di_, before_y));
    Pair<V> frames = texels.template half_of_four_halves<0>(job_.visibility_length);
    const Pair<V> noise = texels.template half_of_four_fractions<1>(job_.visibility);
    frames.x = counted(frames.x, noise.x);
    frames.y =
        c.indirect_side == 0 ? counted(frames.y, noise.y) : indirect_frames(before_x, before_y);
    const V reflected = texels.template half_of_four_halves<0>(job_.specular_length).x;
    const V away = hn::Abs(texels.template half_of_four_halves<1>(job_.specular_distance).y);
    const auto packed =
        hn::LoadU(hn::RebindToUnsigned<D>(), row_of<const std::uint32_t>(job_.surface, y) + x);
    const V roughness = unorm8<0>(d_, packed), metallic = unorm8<8>(d_, packed);
    const M mirrors = hn::Or(hn::Lt(roughness, set(shared::plan_smooth_roughness)),
                             hn::Gt(metallic, set(shared::plan_metallic)));
    const auto most = [&](shared::uint count) HWY_ATTR { return whole(static_cast<int>(count)); };
    const VI now = turn(x, y, 0);
    const MI lit = is_sampled(frames.x, most(c.shadows_most), now);
    const MI ambient_turn = has_ambient_turn(x, y, now, c.ambient_least);
    const MI short_history = hn::RebindMask(di_, hn::Lt(frames.y, set(c.full_frames)));
    const MI open =
        hn::And(ambient_turn, hn::Or(short_history, has_ambient_turn(x, y, now, c.ambient_most)));
    const MI mirrored = is_sampled(
        hn::IfThenElse(mirrors, reflected, reflected * set(shared::plan_quiet_factor)),
        hn::IfThenElse(hn::RebindMask(di_, mirrors), most(c.mirrors_most), most(c.specular_most)),
        turn(x, y, shared::plan_turns / 2));
    VI word = hn::ShiftRight<16>(hn::BitCast(di_, away));
    const V ambient = texels.template half_of_four_fractions<0>(job_.visibility).y;
    const bool traced = shared::traces_ambient(job_.frame.flags);
    const V steps = (traced ? ambient : set(1.0f)) * set(shared::plan_visibility_steps);
    word = hn::Or(word, hn::ShiftLeft<static_cast<int>(shared::plan_visibility_shift)>(
                            hn::ConvertTo(di_, steps + half)));
    word = hn::Or(word, hn::IfThenElseZero(lit, whole(shared::plan_shadows)));
    word = hn::Or(word, hn::IfThenElseZero(open, whole(shared::plan_ambient)));
    const VI reflection =
        hn::IfThenElse(is_faded(roughness, metallic, x, y), whole(static_cast<int>(c.faded)),
                       whole(shared::plan_specular));
    word = hn::Or(word, hn::IfThenElseZero(mirrored, reflection));
    const VI all = hn::IfThenElse(ambient_turn, whole(shared::plan_all),
                                  whole(shared::plan_all & ~shared::plan_ambient));
    word = hn::IfThenElse(known, word, all);
    hn::StoreU(word, di_, row_of<int>(job_.planned, y) + x);
  }

  const D d_{};
  const DI di_{};
  const SamplingPlanJob& job_;
  Bounds<D> bounds_;
  Bounds<D> half_bounds_;
  int turn_;
  int fine_turn_;
  RandomNumbers<DU> fades_;
};

void plan_rows(const SamplingPlanJob& job, int first, int last) {
  run_rows<Planning>(job, job.width, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(plan_rows);

void sampling_plan(const SamplingPlanJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(plan_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
