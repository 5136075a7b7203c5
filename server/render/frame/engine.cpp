#include "gpu/device/several_devices.hpp"
#include "render/api/devices.hpp"
#include "render/api/kept_textures.hpp"
#include "render/frame/engine_parts.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/resources/heap_textures.hpp"
#include "render/resources/scene_resources.hpp"
#include "render/resources/tables/jpeg_tables.hpp"
#include "shaders/embedded.hpp"
#include "tracing/tracer_choice.hpp"

namespace heliograph::render {
namespace {

protocol::DeviceType device_type(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return protocol::DeviceType::cpu;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return protocol::DeviceType::integrated;
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return protocol::DeviceType::discrete;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return protocol::DeviceType::virtual_;
    default:
      return protocol::DeviceType::other;
  }
}

/// "embree, software": the first is what the device gets unasked.
std::string tracer_names(const gpu::DeviceReport& report) {
  std::string names;
  for (const protocol::TracerKind kind : tracing::supported_tracers(report)) {
    names += (names.empty() ? "" : ", ") + std::string(protocol::enum_name(kind));
  }
  return names;
}

/// What lives on a device keeps it alive.
template <class Made>
std::shared_ptr<const Made> with_device(std::shared_ptr<Engine::Parts> parts,
                                        std::shared_ptr<const Made> made) {
  struct Both {
    std::shared_ptr<Engine::Parts> parts;
    std::shared_ptr<const Made> made;
  };
  const Made* const it = made.get();
  return {std::make_shared<const Both>(Both{std::move(parts), std::move(made)}), it};
}

std::unique_ptr<gpu::ShaderReload> make_shader_reload(const gpu::Device& device,
                                                      const std::filesystem::path& folder) {
  if (folder.empty()) return nullptr;
  return std::make_unique<gpu::ShaderReload>(device, folder, shaders::all);
}

/// None where the device does not encode.
gpu::Buffer jpeg_tables_for(const gpu::Device& device, const EngineOptions& options) {
  // The errors of shaders that do not compile are drawn over the pixels on the host.
  const bool reloads = !options.shader_folder.empty();
  const bool encodes =
      options.jpeg == JpegEncoding::automatic ? !device.is_cpu() : options.jpeg == JpegEncoding::on;
  return encodes && !reloads ? make_jpeg_tables(device) : gpu::Buffer();
}

bool compresses_textures(const gpu::Device& device, CompressedTextures wanted) {
  if (!device.samples_bc7()) return false;
  return wanted == CompressedTextures::automatic ? !device.is_cpu()
                                                 : wanted == CompressedTextures::on;
}

UploadChoices upload_choices(const Engine::Parts& parts) {
  return {parts.host_kernels, parts.compressed_textures};
}

scene::Scene make_empty_scene() {
  scene::Scene scene;
  scene.name = "empty";
  scene.material_names.emplace_back("none");
  scene.materials.emplace_back();
  for (const auto slot :
       {&shared::Material::base_color_texture, &shared::Material::metallic_roughness_texture,
        &shared::Material::normal_texture, &shared::Material::occlusion_texture,
        &shared::Material::emissive_texture}) {
    (scene.materials.back().*slot).texture = shared::no_texture;
  }
  return scene;
}

}  // namespace

Engine::Parts::Parts(const EngineOptions& options)
    : instance(options.validation),
      device(instance, {options.device, options.cache_folder, options.as_gpu}),
      shader_reload(make_shader_reload(device, options.shader_folder)),
      programs(device),
      environments(device, programs),
      tracer(tracing::make_tracer(options.tracer, device)),
      split_sum_table(make_split_sum_table(device, programs)),
      sheen_table(make_sheen_table(device, programs)),
      ltc_table(make_ltc_image(device)),
      jpeg_tables(jpeg_tables_for(device, options)),
      around(make_environment_sampler(device, true)),
      clamped(make_environment_sampler(device, false)),
      info{device.report().name, device.report().driver, device_type(device.report().type)},
      host_kernels(options.host_kernels && !shader_reload),
      compressed_textures(compresses_textures(device, options.compressed_textures)) {}

Engine::Engine(const EngineOptions& options)
    : options_(options), parts_(std::make_shared<Parts>(options)) {}
Engine::~Engine() = default;

std::shared_ptr<Engine::Parts> Engine::current() const {
  const std::lock_guard lock(mutex_);
  return parts_;
}

void Engine::recreate() {
  auto made = std::make_shared<Parts>(options_);
  const std::lock_guard lock(mutex_);
  if (made->shader_reload) made->shader_reload->listen(shader_listener_);
  submissions_before_ += parts_->device.queues().submissions();
  parts_.swap(made);
}

DeviceInfo Engine::device() const {
  return current()->info;
}
protocol::TracerKind Engine::tracer() const {
  return current()->tracer->kind();
}
bool Engine::encodes_jpeg() const {
  return static_cast<bool>(current()->jpeg_tables);
}

void Engine::on_shader_change(std::function<void(const ShaderReport&)> listener) {
  const std::lock_guard lock(mutex_);
  shader_listener_ = std::move(listener);
  if (parts_->shader_reload) parts_->shader_reload->listen(shader_listener_);
}

std::string Engine::shader_error() const {
  const std::shared_ptr<Parts> parts = current();
  return parts->shader_reload ? parts->shader_reload->error() : std::string();
}

std::uint32_t Engine::max_image_size() const {
  return std::min(current()->device.limits().maxImageDimension2D, 8192u);
}

std::uint64_t Engine::validation_messages() const {
  return current()->instance.validation_messages();
}

std::size_t Engine::frames_at_once() const {
  const auto parts = current();
  // Queues for compute alone draw no triangles.
  const bool computes = rays_find_gbuffer_sooner(parts->device.report(), parts->tracer->kind());
  const std::size_t queues = computes ? parts->device.queues().compute_count() : 1;
  return queues + queues / 2;
}

std::uint64_t Engine::submissions() const {
  const std::lock_guard lock(mutex_);
  return submissions_before_ + parts_->device.queues().submissions();
}

std::shared_ptr<const SceneResources> Engine::upload(std::shared_ptr<const scene::Scene> scene,
                                                     const scene::Environment& environment,
                                                     const UploadProgress& progress) {
  return upload(std::move(scene), std::make_shared<const scene::Environment>(environment),
                progress);
}

std::shared_ptr<const SceneResources> Engine::upload(
    std::shared_ptr<const scene::Scene> scene,
    std::shared_ptr<const scene::Environment> environment, const UploadProgress& progress) {
  return upload_images(std::move(scene), std::move(environment), progress, [](std::size_t) {});
}

std::shared_ptr<const SceneResources> Engine::upload_and_free_pixels(
    std::unique_ptr<scene::Scene> scene, std::shared_ptr<const scene::Environment> environment,
    const UploadProgress& progress, std::shared_ptr<const SceneResources> first) {
  const std::shared_ptr<scene::Scene> own = std::move(scene);
  return upload_images(
      own, std::move(environment), progress,
      [&images = own->images](std::size_t i) {
        if (images[i].file) std::vector<std::uint8_t>().swap(images[i].pixels);
      },
      std::move(first));
}

std::shared_ptr<const SceneResources> Engine::upload_images(
    std::shared_ptr<const scene::Scene> scene,
    std::shared_ptr<const scene::Environment> environment, const UploadProgress& progress,
    const std::function<void(std::size_t image)>& image_done,
    std::shared_ptr<const SceneResources> first) {
  const auto report = [&](std::string_view stage, float fraction) {
    if (progress) progress(stage, fraction);
  };
  report("environment", 0.0f);
  const std::shared_ptr<Parts> parts = current();
  auto around = parts->environments.get(std::move(environment));
  if (first && &first->environment->device() != &parts->device) first = nullptr;
  return with_device(parts,
                     std::make_shared<const SceneResources>(
                         parts->device, parts->programs, upload_choices(*parts), std::move(scene),
                         std::move(around), *parts->tracer, report, image_done, first));
}

std::shared_ptr<const SceneResources> Engine::empty_scene() {
  const std::shared_ptr<Parts> parts = current();
  const std::lock_guard lock(parts->empty_mutex);
  if (!parts->empty) {
    auto black =
        std::make_shared<const scene::Environment>(scene::constant_environment(glm::vec3(0.0f)));
    parts->empty = std::make_shared<const SceneResources>(
        parts->device, parts->programs, upload_choices(*parts),
        std::make_shared<const scene::Scene>(make_empty_scene()),
        parts->environments.get(std::move(black)), *parts->tracer, [](std::string_view, float) {},
        [](std::size_t) {});
  }
  return with_device(parts, parts->empty);
}

std::shared_ptr<const LitEnvironment> Engine::renew(const LitEnvironment& lost) {
  const std::shared_ptr<Parts> parts = current();
  return with_device(parts, parts->environments.get(lost.source()));
}

std::shared_ptr<const SceneResources> Engine::renew(const SceneResources& lost) {
  return upload(lost.scene, lost.environment->source());
}

bool Engine::owns(const SceneResources& resources) const {
  return owns(*resources.environment);
}

bool Engine::owns(const LitEnvironment& environment) const {
  return &environment.device() == &current()->device;
}

const std::shared_ptr<const scene::Scene>& scene_of(const SceneResources& resources) {
  return resources.scene;
}

scene::KeptTextures kept_textures(Engine& engine) {
  return kept_textures(engine.parts().device);
}

std::uint64_t memory_bytes(const SceneResources& resources) {
  return resources.bytes();
}

std::shared_ptr<const LitEnvironment> Engine::prefilter(scene::Environment environment) {
  const std::shared_ptr<Parts> parts = current();
  return with_device(
      parts,
      parts->environments.get(std::make_shared<const scene::Environment>(std::move(environment))));
}

std::vector<std::string> device_names(std::string_view list) {
  std::vector<std::string> names;
  std::string name;
  int depth = 0;  // of parentheses
  const auto add = [&] {
    const std::size_t begin = std::min(name.find_first_not_of(' '), name.size());
    name = name.substr(begin, name.find_last_not_of(' ') + 1 - begin);
    if (!name.empty()) names.push_back(name);
    name.clear();
  };
  for (const char c : list) {
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (c == ',' && depth <= 0) {
      add();
    } else {
      name += c;
    }
  }
  add();
  return names;
}

std::vector<EngineOptions> choose_devices(const EngineOptions& options) {
  std::vector<std::string> names = device_names(options.device);
  if (names.size() > 1 || (names.size() == 1 && names.front() == gpu::all_devices)) {
    const gpu::Instance instance(false);
    names = gpu::choose_devices(gpu::survey_devices(instance, {}), names);
  }
  if (names.size() > 1) gpu::dispatch_by_handle();
  std::vector<EngineOptions> engines(std::max<std::size_t>(names.size(), 1), options);
  for (std::size_t i = 0; i < names.size(); ++i) engines[i].device = names[i];
  return engines;
}

std::optional<std::uint64_t> free_memory(Engine& engine) {
  return gpu::free_memory(engine.parts().device.physical());
}

namespace {

/// What a survey for each of the names says, as one: whatever one of them chooses is chosen.
std::vector<gpu::DeviceReport> survey(const gpu::Instance& instance, const std::string& list) {
  std::vector<gpu::DeviceReport> reports = gpu::survey_devices(instance, {});
  const auto names = gpu::choose_devices(reports, device_names(list));
  if (names.empty()) return reports;
  reports = gpu::survey_devices(instance, names.front());
  for (const std::string& name : names) {
    const auto more = gpu::survey_devices(instance, name);
    for (std::size_t i = 0; i < std::min(more.size(), reports.size()); ++i) {
      if (more[i].chosen) reports[i] = more[i];
    }
  }
  return reports;
}

}  // namespace

std::string describe_devices(const EngineOptions& options) {
  std::string text = "Driver files and what each finds alone:\n";
  try {
    const auto drivers = gpu::examine_driver_files();
    for (const auto& driver : drivers)
      text += "  " + driver.file + "\n    " + driver.verdict + "\n";
    if (drivers.empty()) text += "  none found\n";
    const gpu::Instance instance(false);
    text += "Devices:\n";
    bool chosen = false;
    for (const auto& report : survey(instance, options.device)) {
      text += std::string(report.chosen ? "* " : "  ") + report.name + ", " +
              gpu::type_name(report.type) + ", Vulkan " + report.version + ", " + report.driver +
              "\n    " + (report.chosen ? "chosen: " : "not chosen: ") + report.reason + "\n";
      if (report.missing.empty()) {
        text += "    ray tracers, the default first: " + tracer_names(report) + "\n";
      }
      chosen |= report.chosen;
    }
    if (!chosen) {
      text += "  none will do; mesa-vulkan-drivers has one for machines without a GPU\n";
    }
  } catch (const gpu::GpuError& error) {
    text += std::string("Vulkan does not start: ") + error.what() + "\n";
  }
  return text;
}

}  // namespace heliograph::render
