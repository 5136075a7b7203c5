#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "shaders/shared/ray.h"
#include "tracing/embree/embree.hpp"
#include "tracing/embree/embree_batch.hpp"
#include "tracing/embree/embree_scene.hpp"
#include "tracing/stoppable_tracer.hpp"

namespace heliograph::tracing {
namespace {

class EmbreeStructure : public virtual AccelerationStructure {
 public:
  explicit EmbreeStructure(EmbreeScene scene) : scene_(std::move(scene)) {}

  const EmbreeScene& scene() const { return scene_; }
  std::uint64_t bytes() const override { return bytes_; }
  void set_bytes(std::int64_t bytes) {
    bytes_ = static_cast<std::uint64_t>(std::max<std::int64_t>(bytes, 0));
  }

 protected:
  EmbreeScene scene_;

 private:
  std::uint64_t bytes_ = 0;
};

class MovingEmbreeStructure : public EmbreeStructure, public MovingStructure {
 public:
  using EmbreeStructure::EmbreeStructure;

  void update(const Movement& movement) override {
    if (!movement.deformed.empty()) scene_.refit(movement.deformed);
    for (const std::uint32_t i : movement.moved) scene_.place(i, movement.worlds[i]);
    if (!movement.deformed.empty() || !movement.moved.empty()) scene_.commit();
  }
};

std::span<const std::uint8_t> mapped_bytes(const gpu::Buffer& buffer) {
  return {reinterpret_cast<const std::uint8_t*>(buffer.mapped()), buffer.size()};
}

template <typename Element>
Element* mapped(const gpu::FramePlan& plan, gpu::BufferRef buffer) {
  return reinterpret_cast<Element*>(plan.get(buffer).mapped());
}

/// Rays per call of Embree: as many as it takes, unless cores would wait for the last batches.
std::size_t batch_size(std::size_t count) {
  constexpr std::size_t batches_per_core = 4, least = 256;
  const auto cores = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t share = count / (batches_per_core * cores) / least * least;
  return std::clamp(share, least, embree_batch);
}

/// Calls `trace(batch, results)` for every batch of the stream, on all cores.
template <typename Result, typename Trace>
void trace_batches(const gpu::FramePlan& plan, const RayStream& stream, gpu::BufferRef results,
                   const Trace& trace) {
  const auto& header = *mapped<const shared::RayCount>(plan, stream.count);
  const std::size_t count = std::min(header.count, stream.capacity);
  const std::span rays(mapped<const shared::Ray>(plan, stream.rays), count);
  auto* const output = mapped<Result>(plan, results);
  const std::size_t size = batch_size(count);
  const std::size_t batches = (count + size - 1) / size;
  tbb::parallel_for(std::size_t(0), batches, [&](std::size_t batch) {
    if (plan.is_canceled()) return;
    const std::size_t first = batch * size;
    trace(RayBatch{.rays = rays.subspan(first, std::min(size, count - first)),
                   .blending = header.blending,
                   .coherent = stream.kind == RayKind::camera},
          output + first);
  });
}

class EmbreeTracer : public StoppableTracer {
 public:
  explicit EmbreeTracer(const gpu::Device& device) : embree_(make_embree_device()) {
    rtcSetDeviceMemoryMonitorFunction(embree_.get(), count_bytes, &bytes_);
    if (device.is_cpu()) return;
    throw gpu::GpuError("the tracer \"embree\" traces rays in CPU memory, but " +
                        device.report().name + " is not a CPU device; use \"software\"");
  }

  protocol::TracerKind kind() const override { return protocol::TracerKind::embree; }

  std::shared_ptr<const AccelerationStructure> build_unless_stopped(
      const scene::Scene& scene, const SceneBuffers& buffers,
      const std::stop_token& stop) const override {
    const std::int64_t before = bytes_;
    auto structure = std::make_shared<EmbreeStructure>(
        EmbreeScene(embree_.get(), scene, mapped_bytes(buffers.alpha_heap), {}, stop));
    structure->set_bytes(bytes_ - before);
    return structure;
  }

  std::shared_ptr<const AccelerationStructure> build_apart(
      const scene::Scene& scene, const SceneBuffers& buffers) const override {
    return std::make_shared<EmbreeStructure>(
        EmbreeScene(embree_.get(), scene, mapped_bytes(buffers.alpha_heap), {.flat = false}));
  }

  std::shared_ptr<const AccelerationStructure> build_without(
      const std::vector<bool>& hidden, std::shared_ptr<const AccelerationStructure> rest,
      const scene::Scene& scene, const SceneBuffers&) const override {
    return std::make_shared<EmbreeStructure>(EmbreeScene(
        embree_.get(), scene, dynamic_cast<const EmbreeStructure&>(*rest).scene(), hidden));
  }

  std::unique_ptr<MovingStructure> build_moving(std::shared_ptr<const AccelerationStructure> rest,
                                                const scene::Scene& scene,
                                                const SceneTables&) const override {
    return std::make_unique<MovingEmbreeStructure>(
        EmbreeScene(embree_.get(), scene, dynamic_cast<const EmbreeStructure&>(*rest).scene()));
  }

  void trace_closest(gpu::FramePlan& plan, const std::string& name,
                     const AccelerationStructure& structure, const RayStream& rays,
                     gpu::BufferRef hits) const override {
    const EmbreeScenes scenes =
        dynamic_cast<const EmbreeStructure&>(structure).scene().scenes(rays.kind);
    plan.host(name,
              [&plan, scenes, rays, hits] {
                trace_batches<shared::Hit>(plan, rays, hits,
                                           [&](const RayBatch& batch, shared::Hit* results) {
                                             intersect_batch(scenes, batch, results);
                                           });
              })
        .read(rays.count)
        .read(rays.rays)
        .write(hits);
  }

  void trace_any(gpu::FramePlan& plan, const std::string& name,
                 const AccelerationStructure& structure, const RayStream& rays,
                 gpu::BufferRef occluded) const override {
    const EmbreeScenes scenes =
        dynamic_cast<const EmbreeStructure&>(structure).scene().scenes(rays.kind);
    plan.host(name,
              [&plan, scenes, rays, occluded] {
                trace_batches<std::uint32_t>(plan, rays, occluded,
                                             [&](const RayBatch& batch, std::uint32_t* results) {
                                               occluded_batch(scenes, batch, results);
                                             });
              })
        .read(rays.count)
        .read(rays.rays)
        .write(occluded);
  }

 private:
  static bool count_bytes(void* count, ssize_t bytes, bool) {
    *static_cast<std::atomic<std::int64_t>*>(count) += bytes;
    return true;
  }

  std::atomic<std::int64_t> bytes_ = 0;  // allocated by Embree; outlives the device
  EmbreeHandle<RTCDevice> embree_;
};

}  // namespace

std::unique_ptr<RayTracer> make_embree_tracer(const gpu::Device& device) {
  return std::make_unique<EmbreeTracer>(device);
}

}  // namespace heliograph::tracing
