#include "render/resources/scene_resources.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <future>
#include <map>
#include <stop_token>
#include <tuple>

#include "render/resources/heap_textures.hpp"
#include "render/resources/lights/light_table.hpp"
#include "render/resources/placement.hpp"
#include "render/resources/sampled_texture.hpp"
#include "scene/gltf/materials/images.hpp"
#include "scene/gltf/materials/layer_table.hpp"
#include "scene/image/mipmaps.hpp"
#include "scene/import.hpp"
#include "tracing/bvh/alpha_mask.hpp"
#include "tracing/stoppable_tracer.hpp"

namespace heliograph::render {
namespace {

bool binds(const gpu::Device& device, std::uint64_t bytes) {
  return bytes <= device.limits().maxStorageBufferRange;
}

void check_size(const gpu::Device& device, const char* name, std::uint64_t bytes) {
  if (binds(device, bytes)) return;
  throw scene::ImportError("the scene's " + std::string(name) + " take " +
                           std::to_string(bytes >> 20) + " MiB; this device binds at most " +
                           std::to_string(device.limits().maxStorageBufferRange >> 20) + " MiB");
}

template <typename Element>
gpu::Buffer upload(const gpu::Device& device, const char* name,
                   const std::vector<Element>& elements, VkBufferUsageFlags usage = 0) {
  const auto bytes = std::as_bytes(std::span(elements));
  check_size(device, name, bytes.size());
  return gpu::upload_buffer(device, name, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | usage);
}

template <typename Element>
std::uint64_t bytes_of_meshes(const std::vector<scene::Mesh>& meshes,
                              std::vector<Element> scene::Mesh::*list) {
  std::uint64_t bytes = 0;
  for (const scene::Mesh& mesh : meshes) bytes += (mesh.*list).size() * sizeof(Element);
  return bytes;
}

/// One list of all meshes, one after the other, without a copy in between where the device's memory
/// is ours.
template <typename Element>
gpu::Buffer upload_of_meshes(const gpu::Device& device, const char* name,
                             const std::vector<scene::Mesh>& meshes,
                             std::vector<Element> scene::Mesh::*list, VkBufferUsageFlags usage) {
  const std::size_t count = bytes_of_meshes(meshes, list) / sizeof(Element);
  const auto gather = [&](Element* to) {
    for (const scene::Mesh& mesh : meshes) to = std::ranges::copy(mesh.*list, to).out;
  };
  usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  if (device.is_cpu()) {
    gpu::Buffer buffer(device, name, count * sizeof(Element), usage, gpu::Memory::device);
    gather(reinterpret_cast<Element*>(buffer.mapped()));
    return buffer;
  }
  std::vector<Element> gathered(count);
  gather(gathered.data());
  return gpu::upload_buffer(device, name, std::as_bytes(std::span(gathered)), usage);
}

VkSamplerAddressMode address_mode(std::uint32_t wrap) {
  switch (wrap) {
    case shared::wrap_clamp:
      return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case shared::wrap_mirror:
      return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    default:
      return VK_SAMPLER_ADDRESS_MODE_REPEAT;
  }
}

VkFilter filter(scene::Filter from) {
  return from == scene::Filter::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
}

VkSamplerCreateInfo sampler_info(const scene::Sampler& from) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = filter(from.magnify);
  info.minFilter = filter(from.minify);
  info.mipmapMode = from.mip_filter == scene::Filter::nearest ? VK_SAMPLER_MIPMAP_MODE_NEAREST
                                                              : VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.addressModeU = address_mode(from.wrap_s);
  info.addressModeV = address_mode(from.wrap_t);
  info.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
  info.maxLod = from.mipmapped ? VK_LOD_CLAMP_NONE : 0.25f;  // glTF without mipmaps: Vulkan's hint
  return info;
}

gpu::Image constant_texture(const gpu::Device& device, const char* name,
                            std::array<std::uint8_t, 4> texel) {
  gpu::ImageDesc desc{.name = name, .extent = {1, 1}, .format = VK_FORMAT_R8G8B8A8_UNORM};
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  gpu::Image image(device, desc);
  image.upload(std::as_bytes(std::span(texel)));
  return image;
}

/// How often a load that waits tells that it goes on, which may end it.
constexpr std::chrono::milliseconds progress_interval{50};

std::shared_ptr<const tracing::AccelerationStructure> build_structure(
    const tracing::RayTracer& tracer, const scene::Scene& scene,
    const tracing::SceneBuffers& tables, const std::stop_token& stop) {
  const auto* const stoppable = dynamic_cast<const tracing::StoppableTracer*>(&tracer);
  return stoppable ? stoppable->build_unless_stopped(scene, tables, stop)
                   : tracer.build(scene, tables);
}

struct StopAtEnd {
  std::stop_source& source;
  ~StopAtEnd() { source.request_stop(); }
};

}  // namespace

SceneResources::SceneResources(const gpu::Device& device, const Programs& programs,
                               UploadChoices choices, std::shared_ptr<const scene::Scene> source,
                               std::shared_ptr<const LitEnvironment> around,
                               const tracing::RayTracer& tracer, const UploadProgress& progress,
                               const ImageDone& image_done,
                               const std::shared_ptr<const SceneResources>& first)
    : scene(std::move(source)),
      environment(std::move(around)),
      emission_means(*scene),
      device_(device),
      programs_(programs),
      compressed_textures_(choices.compressed_textures),
      white_(constant_texture(device, "white", {255, 255, 255, 255})),
      flat_normal_(constant_texture(device, "flat normal", {128, 128, 255, 255})) {
  progress("tables", 0.1f);
  upload_tables(device, choices.host_kernels, first.get());
  make_samplers();
  // Beside the textures, which one thread copies.
  std::stop_source stop;
  const bool shared = first && tracing::cover_alike(first->scene->materials, scene->materials);
  auto structure = std::async(std::launch::async, [&] {
    return shared ? nullptr : build_structure(tracer, *scene, rest_tables, stop.get_token());
  });
  // Destroyed before the future, which waits for its thread.
  const StopAtEnd stops_with_this{stop};
  upload_textures(progress, image_done);
  upload_emissive_triangles();
  if (device.is_cpu()) {
    host_materials = make_host_materials({scene->materials, scene->layers});
  } else {
    material_sets();
  }
  list_draws();
  do {
    progress("acceleration structure", 0.5f);
  } while (structure.wait_for(progress_interval) != std::future_status::ready);
  rest_structure = structure.get();
  if (shared) share_structure(first);
}

/// The structure refers to masks of `first`, which stays as long as it does.
void SceneResources::share_structure(const std::shared_ptr<const SceneResources>& first) {
  rest_structure = {first, first->rest_structure.get()};
  first_bytes_ = first->bytes_of_its_own();
}

std::uint64_t SceneResources::bytes() const {
  std::uint64_t sum = rest_structure->bytes() + first_bytes_ + bytes_of_its_own();
  for (const gpu::Buffer* buffer :
       {&geometry_->vertices, &geometry_->indices, &geometry_->meshes, &geometry_->instances}) {
    sum += buffer->size();
  }
  return sum;
}

/// Without what a scene and its first view share.
std::uint64_t SceneResources::bytes_of_its_own() const {
  std::uint64_t sum = emission_means.bytes();
  for (const gpu::Buffer* buffer :
       {&rest_tables.materials, &rest_tables.lights, &rest_tables.alpha_heap, &texture_heap.texels,
        &texture_heap.textures, &layers, &emissive.table, &emissive.first}) {
    sum += buffer->size();
  }
  const std::lock_guard lock(sampled_mutex_);
  if (material_sets_) sum += material_sets_->blocks.size() + material_sets_->layer_blocks.size();
  for (const gpu::Image& image : images_) sum += gpu::packed_bytes(image.desc());
  return sum;
}

void SceneResources::upload_tables(const gpu::Device& device, bool host_kernels,
                                   const SceneResources* first) {
  const std::uint64_t vertex_bytes = bytes_of_meshes(scene->meshes, &scene::Mesh::vertices);
  const std::uint64_t index_bytes = bytes_of_meshes(scene->meshes, &scene::Mesh::indices);
  for_kernels_only = device.is_cpu() && host_kernels &&
                     !(binds(device, vertex_bytes) && binds(device, index_bytes));
  if (!for_kernels_only) {
    check_size(device, "vertices", vertex_bytes);
    check_size(device, "indices", index_bytes);
  }
  std::uint64_t vertices = 0, indices = 0;
  for (const scene::Mesh& mesh : scene->meshes) {
    meshes_.push_back({static_cast<std::uint32_t>(indices),
                       static_cast<std::uint32_t>(mesh.indices.size()),
                       static_cast<std::uint32_t>(vertices), mesh.material});
    vertices += mesh.vertices.size();
    indices += mesh.indices.size();
  }
  for (const scene::Instance& from : scene->instances) {
    instances_.push_back(place_mesh(from.mesh, scene->nodes[from.node].world));
  }
  std::vector<shared::Light> lights;
  for (const scene::Light& light : scene->lights) lights.push_back(light.device);

  geometry_ = first ? first->geometry_ : upload_geometry(device);
  bind_geometry();
  rest_tables.materials = upload(device, "materials", scene->materials);
  const auto& materials = scene->materials;
  const bool blends =
      std::any_of(materials.begin(), materials.end(), [](const shared::Material& material) {
        return (material.flags & shared::material_alpha_blend) != 0;
      });
  const bool transmits = std::ranges::any_of(
      scene->layers, [](const shared::MaterialLayer& layer) { return layer.transmission > 0.0f; });
  features = light_features(lights) | (scene->deformations.empty() ? 0u : shared::scene_deforms) |
             (blends ? shared::scene_blends : 0u) |
             (scene->layers.size() > 1 ? shared::scene_layers : 0u) |
             (transmits ? shared::scene_transmits : 0u) |
             (scene::scatters_through(scene->layers) ? shared::scene_diffuse_transmits : 0u) |
             (scene::disperses(scene->layers) ? shared::scene_disperses : 0u);
  layers = upload(device, "material layers",
                  scene->layers.empty() ? std::vector{scene::plain_layer()} : scene->layers);
  rest_tables.lights = make_light_table(device, lights);
  write_lights(rest_tables.lights, lights, scene->bounds);
  rest_tables.alpha_heap =
      upload(device, "alpha masks", scene->alpha_heap, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  rest_tables.alpha_heap.texel_view(VK_FORMAT_R32_UINT);  // before other threads share it
}

std::shared_ptr<const SceneResources::Geometry> SceneResources::upload_geometry(
    const gpu::Device& device) const {
  auto made = std::make_shared<Geometry>();
  made->vertices = upload_of_meshes(device, "vertices", scene->meshes, &scene::Mesh::vertices,
                                    VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  made->indices = upload_of_meshes(device, "indices", scene->meshes, &scene::Mesh::indices,
                                   VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  made->meshes = upload(device, "meshes", meshes_);
  made->instances = upload(device, "instances", instances_);
  return made;
}

void SceneResources::bind_geometry() {
  const auto bind = [this](const gpu::Buffer& buffer) {
    return gpu::Buffer(std::shared_ptr<const gpu::Buffer>(geometry_, &buffer));
  };
  rest_tables.vertices = bind(geometry_->vertices);
  rest_tables.indices = bind(geometry_->indices);
  rest_tables.meshes = bind(geometry_->meshes);
  rest_tables.instances = bind(geometry_->instances);
}

void SceneResources::upload_textures(const UploadProgress& progress, const ImageDone& image_done) {
  const auto& images = scene->images;
  TextureHeapWriter heap(device_, *scene);
  const scene::KeptTextures kept = kept_textures(device_);
  const std::uint32_t longest = scene::longest_side_that_fits(images, kept).value_or(1);
  for (std::size_t i = 0; i < images.size(); ++i) {
    progress("textures", 0.15f + 0.3f * static_cast<float>(i) / static_cast<float>(images.size()));
    const std::uint32_t first = scene::first_level_within(images[i], longest);
    const scene::ImagePixels pixels(images[i], first);
    heap.add(i, pixels.get());
    emission_means.add(*scene, i, pixels.get());
    if (!device_.is_cpu()) add_sampled_texture(images[i], pixels.get());
    image_done(i);
  }
  texture_heap = heap.finish();
}

void SceneResources::upload_emissive_triangles() {
  std::vector<glm::mat4> worlds;
  for (const shared::Instance& instance : instances_) worlds.push_back(instance.world);
  const EmissiveTable table =
      make_emissive_table({*scene, scene->materials, emission_means, worlds});
  emissive = upload_emissive(device_, table);
  emissive_power = table.header.power;
  if (table.header.count > 0) features |= shared::scene_emissive;
}

void SceneResources::make_missing_images() const {
  while (images_.size() < scene->images.size()) {
    const scene::Image& image = scene->images[images_.size()];
    add_sampled_texture(image, scene::ImagePixels(image, 0).get());
  }
}

void SceneResources::add_sampled_texture(const scene::Image& image,
                                         std::span<const std::uint8_t> pixels) const {
  images_.push_back(make_sampled_texture(device_, image, pixels, compressed_textures_));
}

void SceneResources::make_samplers() {
  std::vector<scene::Sampler> known;
  for (const scene::Texture& texture : scene->textures) {
    const auto found = std::find(known.begin(), known.end(), texture.sampler);
    texture_sampler_.push_back(static_cast<std::uint32_t>(found - known.begin()));
    if (found != known.end()) continue;
    known.push_back(texture.sampler);
    samplers_.emplace_back(device_, sampler_info(texture.sampler));
  }
  samplers_.emplace_back(device_, sampler_info({}));  // for slots without a texture
}

kernels::MaterialTable SceneResources::make_host_materials(const MaterialTables& tables) const {
  const auto* const textures =
      reinterpret_cast<const shared::HeapTexture*>(texture_heap.textures.mapped());
  return kernels::make_material_table(tables.materials, tables.layers,
                                      {textures, scene->textures.size()});
}

const MaterialSets& SceneResources::material_sets() const {
  {
    const std::lock_guard lock(sampled_mutex_);
    if (material_sets_) return *material_sets_;
  }
  MaterialSets made =
      make_material_sets({scene->materials, scene->layers}, (features & shared::scene_layers) != 0,
                         gpu::Memory::device);
  const std::lock_guard lock(sampled_mutex_);
  if (!material_sets_) material_sets_ = std::move(made);
  return *material_sets_;
}

void SceneResources::list_draws() {
  std::map<std::uint32_t, std::uint32_t> previous_vertices;  // by mesh that deforms
  for (const scene::Deformation& deformation : scene->deformations) {
    previous_vertices[deformation.mesh] = deforming_vertices;
    deforming_vertices +=
        static_cast<std::uint32_t>(scene->meshes[deformation.mesh].vertices.size());
  }
  for (std::uint32_t i = 0; i < scene->instances.size(); ++i) {
    const scene::Instance& instance = scene->instances[i];
    const shared::Mesh& mesh = meshes_[instance.mesh];
    const std::uint32_t flags = scene->materials[mesh.material].flags;
    Draw draw{};
    draw.constants = draw_constants(instances_[i], i);
    draw.material = mesh.material;
    draw.first_index = mesh.first_index;
    draw.index_count = mesh.index_count;
    draw.first_vertex = mesh.first_vertex;
    const auto previous = previous_vertices.find(instance.mesh);
    if (previous != previous_vertices.end()) draw.previous_vertex = previous->second;
    draw.masked = flags & (shared::material_alpha_mask | shared::material_alpha_blend);
    draw.double_sided = flags & shared::material_double_sided;
    draw.flipped = instances_[i].flags & shared::instance_flipped;
    draw.bounds =
        scene::world_bounds(scene->meshes[instance.mesh].bounds, scene->nodes[instance.node].world);
    draws.push_back(draw);
  }
  std::sort(draws.begin(), draws.end(), [](const Draw& a, const Draw& b) {
    return std::tie(a.masked, a.material, a.first_index, a.constants.instance) <
           std::tie(b.masked, b.material, b.first_index, b.constants.instance);
  });
}

}  // namespace heliograph::render
