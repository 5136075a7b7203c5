#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shaders/embedded.hpp"
#include "shaders/shared/ray.h"
#include "tracing/bvh/bvh.hpp"
#include "tracing/bvh/device_refit.hpp"
#include "tracing/bvh/moving_bvh.hpp"
#include "tracing/embree/embree.hpp"
#include "tracing/stoppable_tracer.hpp"

namespace heliograph::tracing {
namespace {

void check_texels(const gpu::Device& device, const std::string& name, std::size_t texels) {
  const std::size_t most = device.limits().maxTexelBufferElements;
  if (texels <= most) return;
  throw gpu::GpuError("the scene's " + name + " takes " + std::to_string(texels) +
                      " texels, but the device reads at most " + std::to_string(most));
}

/// What DeviceRefit binds as storage buffers, of scenes whose meshes deform.
void check_refit(const gpu::Device& device, const scene::Scene& scene, const Bvh& bvh) {
  if (scene.deformations.empty()) return;
  const std::size_t most = device.limits().maxStorageBufferRange;
  const std::size_t records = moving_record_count(bvh, scene.instances.size());
  std::size_t vertices = 0;
  for (const scene::Deformation& deformation : scene.deformations) {
    vertices += scene.meshes[deformation.mesh].vertices.size();
  }
  const std::size_t bytes =
      std::max({records * sizeof(shared::BvhNode), bvh.triangles.size() * sizeof(glm::vec4),
                vertices * sizeof(glm::vec3)});
  if (bytes <= most) return;
  throw gpu::GpuError("the hierarchy of a scene with deforming meshes takes " +
                      std::to_string(bytes >> 20) +
                      " MiB, but shaders of the device write at most " +
                      std::to_string(most >> 20) + " MiB of a buffer");
}

/// Uploads RGBA32F texels. Creates the view here on the building thread, because plans of several
/// threads share it.
template <typename Element>
gpu::Buffer upload_texels(const gpu::Device& device, const std::string& name,
                          const std::vector<Element>& elements) {
  const auto bytes = std::as_bytes(std::span(elements));
  check_texels(device, name, bytes.size() / sizeof(glm::vec4));
  gpu::Buffer buffer =
      gpu::upload_buffer(device, name, bytes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  buffer.texel_view(VK_FORMAT_R32G32B32A32_SFLOAT);
  return buffer;
}

/// Bindings of a tracing pass: the tables are constant, the root may change.
struct SoftwareTables {
  const gpu::Buffer& records;
  const gpu::Buffer& triangles;
  const gpu::Buffer& alpha_heap;
};

class SoftwareStructure : public virtual AccelerationStructure {
 public:
  virtual SoftwareTables tables() const = 0;
  virtual std::uint32_t root() const = 0;
  virtual BvhNodes upper_nodes() const = 0;
  virtual WalkedHierarchy::Flat flat_triangles() const = 0;
};

WalkedHierarchy::Flat flat_triangles_of(const Bvh& bvh) {
  // Without any, the flat tree is all that rays can hit, in every pose.
  std::size_t others = 0;
  for (std::size_t i = 0; i < bvh.flat.size(); ++i) others += !bvh.flat[i] && !bvh.hidden[i];
  return {.first = static_cast<std::uint32_t>(bvh.flat_tree.first_triangle),
          .count = static_cast<std::uint32_t>(bvh.flat_tree.triangles),
          .all = others == 0};
}

class StaticSoftwareStructure : public SoftwareStructure {
 public:
  StaticSoftwareStructure(const gpu::Device& device, Bvh bvh, bool moves, const gpu::Buffer& masks)
      : records_(upload_texels(device, "bvh.records", bvh.records)),
        triangles_(upload_texels(device, "bvh.triangles", bvh.triangles)),
        alpha_heap_(masks),
        root_(bvh.root),
        upper_nodes_(bvh.upper_nodes),
        flat_(bvh.is_flat),
        flat_triangles_(flat_triangles_of(bvh)) {
    check_texels(device, masks.name(), masks.size() / sizeof(std::uint32_t));
    if (moves) bvh_ = std::make_shared<const Bvh>(std::move(bvh));
  }

  SoftwareTables tables() const override { return {records_, triangles_, alpha_heap_}; }
  std::uint32_t root() const override { return root_; }
  BvhNodes upper_nodes() const override { return upper_nodes_; }
  WalkedHierarchy::Flat flat_triangles() const override { return flat_triangles_; }
  std::uint64_t bytes() const override { return records_.size() + triangles_.size(); }
  /// Whether what no clip moves is one tree.
  bool flat() const { return flat_; }
  /// Source of the copies for scenes that move; null for others.
  const std::shared_ptr<const Bvh>& bvh() const { return bvh_; }

 private:
  gpu::Buffer records_;
  gpu::Buffer triangles_;
  const gpu::Buffer& alpha_heap_;
  std::uint32_t root_;
  BvhNodes upper_nodes_;
  bool flat_;
  WalkedHierarchy::Flat flat_triangles_;
  std::shared_ptr<const Bvh> bvh_;
};

class MovingSoftwareStructure : public SoftwareStructure, public MovingStructure {
 public:
  MovingSoftwareStructure(const gpu::Device& device, RTCDevice embree,
                          const DeviceRefit::Programs& refit,
                          std::shared_ptr<const StaticSoftwareStructure> rest,
                          const scene::Scene& scene)
      : rest_(std::move(rest)), bvh_(embree, rest_->bvh(), scene) {
    const VkBufferUsageFlags refitted =
        scene.deformations.empty() ? 0 : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    records_ = writable_texels(device, "bvh.moving_records",
                               bvh_.record_count() * sizeof(shared::BvhNode), refitted);
    if (refitted != 0) {
      triangles_ = writable_texels(device, "bvh.moving_triangles", rest_->tables().triangles.size(),
                                   refitted);
    }
    bvh_.start(mapped());
    if (triangles_) {
      refit_.emplace(device, refit, *rest_->bvh(), scene,
                     DeviceRefit::Tables{records_, triangles_});
    }
  }

  SoftwareTables tables() const override {
    const SoftwareTables rest = rest_->tables();
    return {records_, triangles_ ? triangles_ : rest.triangles, rest.alpha_heap};
  }
  std::uint32_t root() const override { return bvh_.root(); }
  BvhNodes upper_nodes() const override { return bvh_.upper_nodes(); }
  WalkedHierarchy::Flat flat_triangles() const override { return rest_->flat_triangles(); }
  void update(const Movement& movement) override {
    bvh_.update(movement, mapped());
    if (movement.deformed.empty()) return;
    for (const Movement::Mesh& mesh : movement.deformed) refit_->move(mesh);
    refit_->run();
  }

 private:
  static gpu::Buffer writable_texels(const gpu::Device& device, const std::string& name,
                                     std::size_t bytes, VkBufferUsageFlags more) {
    check_texels(device, name, bytes / sizeof(glm::vec4));
    gpu::Buffer buffer(device, name, bytes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | more,
                       gpu::Memory::upload);
    buffer.texel_view(VK_FORMAT_R32G32B32A32_SFLOAT);
    return buffer;
  }

  MovingBvh::Tables mapped() const {
    const auto span = [](const gpu::Buffer& buffer, auto* first) {
      return std::span(first, buffer.size() / sizeof *first);
    };
    return {span(records_, reinterpret_cast<shared::BvhNode*>(records_.mapped())),
            span(triangles_, reinterpret_cast<glm::vec4*>(triangles_.mapped()))};
  }

  std::shared_ptr<const StaticSoftwareStructure> rest_;
  MovingBvh bvh_;
  gpu::Buffer records_;
  gpu::Buffer triangles_;
  std::optional<DeviceRefit> refit_;  // of scenes with deforming meshes
};

/// Where lanes of a subgroup walk the hierarchy together, long rays end sooner: on a device with
/// more lanes than rays keep busy. Where the device works on many frames its lanes are busy, and it
/// gets more done with a ray for each.
class TracingProgram {
 public:
  TracingProgram(const gpu::Device& device, const gpu::ShaderBinary& apart,
                 const gpu::ShaderBinary& together)
      : apart_(device, apart) {
    if (!device.is_cpu() && device.subgroup_ballots()) together_.emplace(device, together);
  }

  gpu::PassBuilder pass(gpu::FramePlan& plan, const std::string& name) const {
    if (!together_) return plan.pass(name, apart_);
    return plan.pass(name, *together_).in_a_crowd(apart_);
  }

 private:
  gpu::ComputeProgram apart_;
  std::optional<gpu::ComputeProgram> together_;
};

class SoftwareTracer : public StoppableTracer {
 public:
  explicit SoftwareTracer(const gpu::Device& device)
      : device_(device),
        embree_(make_embree_device()),
        closest_(device, shaders::trace_closest, shaders::trace_closest_together),
        any_(device, shaders::trace_any, shaders::trace_any_together),
        refit_(device) {}

  protocol::TracerKind kind() const override { return protocol::TracerKind::software; }

  std::shared_ptr<const AccelerationStructure> build_unless_stopped(
      const scene::Scene& scene, const SceneBuffers& buffers,
      const std::stop_token& stop) const override {
    return hold(scene, build_bvh(embree_.get(), scene, {}, stop), !scene.clips.empty(), buffers);
  }

  std::shared_ptr<const AccelerationStructure> build_apart(
      const scene::Scene& scene, const SceneBuffers& buffers) const override {
    return hold(scene, build_bvh(embree_.get(), scene, {.flat = false}), true, buffers);
  }

  std::shared_ptr<const AccelerationStructure> build_without(
      const std::vector<bool>& hidden, std::shared_ptr<const AccelerationStructure> rest,
      const scene::Scene& scene, const SceneBuffers& buffers) const override {
    const bool flat = dynamic_cast<const StaticSoftwareStructure&>(*rest).flat();
    return hold(scene, build_bvh(embree_.get(), scene, {.flat = flat, .hidden = hidden}),
                !flat || !scene.clips.empty(), buffers);
  }

  std::unique_ptr<MovingStructure> build_moving(std::shared_ptr<const AccelerationStructure> rest,
                                                const scene::Scene& scene,
                                                const SceneTables&) const override {
    return std::make_unique<MovingSoftwareStructure>(
        device_, embree_.get(), refit_,
        std::dynamic_pointer_cast<const StaticSoftwareStructure>(std::move(rest)), scene);
  }

  void trace_closest(gpu::FramePlan& plan, const std::string& name,
                     const AccelerationStructure& structure, const RayStream& rays,
                     gpu::BufferRef hits) const override {
    add_pass(plan, name, closest_, structure, rays, hits);
  }

  void trace_any(gpu::FramePlan& plan, const std::string& name,
                 const AccelerationStructure& structure, const RayStream& rays,
                 gpu::BufferRef occluded) const override {
    add_pass(plan, name, any_, structure, rays, occluded);
  }

  std::optional<WalkedHierarchy> walked(const AccelerationStructure& structure) const override {
    return walked_bvh(structure);
  }

 private:
  std::shared_ptr<const AccelerationStructure> hold(const scene::Scene& scene, Bvh bvh, bool moves,
                                                    const SceneBuffers& buffers) const {
    if (moves) check_refit(device_, scene, bvh);
    return std::make_shared<StaticSoftwareStructure>(device_, std::move(bvh), moves,
                                                     buffers.alpha_heap);
  }

  static WalkedHierarchy walked_bvh(const AccelerationStructure& structure) {
    const auto& bvh = dynamic_cast<const SoftwareStructure&>(structure);
    const SoftwareTables tables = bvh.tables();
    return {.records = tables.records,
            .triangles = tables.triangles,
            .alpha_heap = tables.alpha_heap,
            .root = [&bvh] { return bvh.root(); },
            .upper_nodes =
                [&bvh] {
                  const BvhNodes nodes = bvh.upper_nodes();
                  return WalkedHierarchy::UpperNodes{nodes.first, nodes.count};
                },
            .flat = bvh.flat_triangles()};
  }

  static void add_pass(gpu::FramePlan& plan, const std::string& name, const TracingProgram& program,
                       const AccelerationStructure& structure, const RayStream& rays,
                       gpu::BufferRef results) {
    const WalkedHierarchy bvh = walked_bvh(structure);
    program.pass(plan, name)
        .read(rays.count)
        .read(rays.rays)
        .read(plan.import(bvh.records))
        .read(plan.import(bvh.triangles))
        .read(plan.import(bvh.alpha_heap))
        .write(results)
        .constants(bvh.root)
        .dispatch_indirect(rays.count, offsetof(shared::RayCount, tracing_groups_x));
  }

  const gpu::Device& device_;
  EmbreeHandle<RTCDevice> embree_;
  TracingProgram closest_;
  TracingProgram any_;
  DeviceRefit::Programs refit_;
};

}  // namespace

std::unique_ptr<RayTracer> make_software_tracer(const gpu::Device& device) {
  return std::make_unique<SoftwareTracer>(device);
}

}  // namespace heliograph::tracing
