#include "scene/import.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <chrono>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include "scene/byte_budget.hpp"
#include "scene/first_failure.hpp"
#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/document/gltf_file.hpp"
#include "scene/gltf/document/references.hpp"
#include "scene/gltf/document/scene_choice.hpp"
#include "scene/gltf/document/variants.hpp"
#include "scene/gltf/environment/image_light.hpp"
#include "scene/gltf/geometry/draco.hpp"
#include "scene/gltf/geometry/meshes.hpp"
#include "scene/gltf/geometry/primitives.hpp"
#include "scene/gltf/geometry/shapes.hpp"
#include "scene/gltf/materials/images.hpp"
#include "scene/gltf/materials/layer_table.hpp"
#include "scene/gltf/materials/materials.hpp"
#include "scene/gltf/materials/texture_overrides.hpp"
#include "scene/gltf/materials/textures.hpp"
#include "scene/gltf/materials/untextured.hpp"
#include "scene/gltf/nodes/animation.hpp"
#include "scene/gltf/nodes/cameras.hpp"
#include "scene/gltf/nodes/lights.hpp"
#include "scene/gltf/nodes/nodes.hpp"
#include "scene/gltf/nodes/placement.hpp"
#include "scene/gltf/parts_done.hpp"
#include "scene/import_error.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {
namespace {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// Seconds since the last call; starts the next lap.
  double lap() {
    const double result = seconds();
    start_ = Clock::now();
    return result;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

class Importer {
 public:
  /// `source`: a path, or an open file.
  template <class Source>
  Importer(Source source, std::string name, const ImportLimits& limits,
           const ImportOptions& options)
      : limits_(limits),
        options_(options),
        stop_(options.stop),
        budget_(limits.scene_bytes),
        texels_(limits.texels) {
    const Stopwatch watch;
    report("reading", 0.0f);
    file_.emplace(std::move(source), limits, warnings_, stop_);
    scene_.name = std::move(name);
    times_.parse = watch.seconds();
  }

  Scene import() {
    Stopwatch watch;
    const tinygltf::Model& model = file_->model();
    const auto shown = choose_scene(model, options_.choice.scene);
    scene_.scenes = read_scene_names(model);
    scene_.shown_scene = shown.value_or(0);
    scene_.choice = options_.choice;
    const std::vector<Accessor> accessors = read_accessors(*file_, limits_, stop_);
    check_skins(model, accessors);
    check_animations(model, accessors);
    TextureTable textures(model);
    MaterialTable materials = read_materials(model, textures, warnings_);
    scene_.materials = std::move(materials.materials);
    scene_.material_names = std::move(materials.names);
    scene_.material_layers = std::move(materials.layers);
    scene_.variants = read_variants(model);
    scene_.variant = choose_variant(scene_.variants, options_.choice.variant);
    const PrimitiveTable primitives =
        read_primitives(*file_, accessors, scene_.variant, limits_, budget_, warnings_, stop_);
    const std::vector<Light> lights = read_lights(model);
    const std::vector<Camera> cameras = read_cameras(model);
    NodeTable nodes = read_nodes(model, accessors, shown, limits_, warnings_, stop_);
    const std::vector<std::uint32_t> mesh_materials = choose_materials(primitives);
    const std::uint64_t image_bytes = options_.untextured ? image_file_bytes(*file_) : 0;
    const bool in_two_steps =
        options_.untextured && options_.textures.empty() && image_bytes >= options_.untextured_from;
    ImageFiles image_files(*file_, limits_, stop_);
    timed(times_.images, [&] {
      scene_.environment = read_image_light(
          model, shown, {image_files, limits_, texels_, budget_, warnings_, stop_});
    });
    std::vector<ImageSource> images;
    if (!in_two_steps) images = image_files.take_all();
    const std::vector<SourceFile> replacing =
        override_textures(options_.textures, scene_, textures, images, limits_, stop_);

    times_.check = watch.lap() - times_.images;
    scene_.textures = textures.used_textures();
    const auto build = [&](PartsDone& done) {
      return timed(times_.geometry,
                   [&] { build_meshes(primitives, accessors, mesh_materials, done); });
    };
    const auto place = [&] {
      Animations animations = read_animations(model, accessors, nodes, budget_, warnings_);
      scene_.clips = std::move(animations.clips);
      scene_.animated_slots = std::move(animations.slots);
      scene_.skins = read_skins(model, accessors, nodes, budget_);
      scene_.nodes = nodes.nodes;
      place_objects(scene_, nodes, {primitives, lights, cameras},
                    {limits_, budget_, warnings_, stop_});
    };
    const std::size_t meshes = primitives.primitives.size();
    const std::size_t uses = textures.image_uses().size();
    if (in_two_steps) {
      PartsDone meshes_done([&](float fraction) { report("meshes", 0.1f + 0.1f * fraction); },
                            meshes, stop_);
      build(meshes_done);
      timed(times_.place, place);
      file_->drop_views();
      options_.untextured(std::make_unique<Scene>(without_textures(scene_)), image_bytes);
      report("textures", 0.2f);
      PartsDone done([&](float fraction) { report("textures", 0.2f + 0.75f * fraction); }, uses,
                     stop_);
      timed(times_.images, [&] {
        images = image_files.take_all();
        decode(images, textures, done);
      });
    } else {
      PartsDone done([&](float fraction) { report("meshes and images", 0.1f + 0.85f * fraction); },
                     meshes + uses, stop_);
      FirstFailure failure;
      tbb::parallel_invoke(
          [&] { failure.guard([&] { build(done); }); },
          [&] {
            failure.guard([&] { timed(times_.images, [&] { decode(images, textures, done); }); });
          });
      failure.rethrow();
      timed(times_.place, place);
    }
    finish_images();
    scene_.warnings = warnings_.take();
    scene_.sources = file_->sources();
    scene_.sources.insert(scene_.sources.end(), replacing.begin(), replacing.end());
    report("done", 1.0f);
    return std::move(scene_);
  }

  const ImportTimes& times() const { return times_; }

 private:
  void report(std::string_view stage, float fraction) const {
    throw_if_cancelled(stop_);
    if (options_.progress) options_.progress(stage, fraction);
  }

  /// Runs `task`, and adds the time that it took to `seconds`.
  template <class Task>
  static void timed(double& seconds, const Task& task) {
    const Stopwatch watch;
    task();
    seconds += watch.seconds();
  }

  void decode(std::span<const ImageSource> sources, const TextureTable& textures, PartsDone& done) {
    const KeptLevels kept{options_.kept_textures, images_with_alpha(textures)};
    decoded_ = decode_images(sources, textures.image_uses(), kept, limits_, texels_, stop_,
                             [&] { done.add_one(); });
  }

  /// Takes the decoded images, and everything that depends on their texels.
  void finish_images() {
    scene_.images = std::move(decoded_.images);
    drop_missing_images(scene_, decoded_.problems, warnings_);
    build_layers(scene_);
    build_alpha_heap(scene_);
    for (Image& image : scene_.images) drop_large_levels(image, decoded_.kept_side);
  }

  // The default material is added only if a primitive has no material.
  std::uint32_t default_material_index() {
    if (!default_material_) {
      default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.push_back(default_material());
      scene_.material_layers.emplace_back();
      scene_.material_names.push_back("default");
    }
    return *default_material_;
  }

  std::vector<std::uint32_t> choose_materials(const PrimitiveTable& table) {
    std::vector<std::uint32_t> materials;
    for (const Primitive& primitive : table.primitives) {
      materials.push_back(primitive.material ? *primitive.material : default_material_index());
    }
    if (scene_.materials.empty()) default_material_index();
    return materials;
  }

  /// Per use of an image: whether rays read its alpha.
  std::vector<bool> images_with_alpha(const TextureTable& textures) const {
    std::vector<bool> result(textures.image_uses().size());
    constexpr std::uint32_t partial = shared::material_alpha_mask | shared::material_alpha_blend;
    for (const shared::Material& material : scene_.materials) {
      const std::uint32_t texture = material.base_color_texture.texture;
      if (!(material.flags & partial) || texture == shared::no_texture) continue;
      result[scene_.textures[texture].image] = true;
    }
    return result;
  }

  void build_meshes(const PrimitiveTable& table, const std::vector<Accessor>& accessors,
                    const std::vector<std::uint32_t>& materials, PartsDone& done) {
    scene_.meshes.resize(table.primitives.size());
    scene_.shapes.resize(table.primitives.size());
    FirstFailure failure;
    tbb::parallel_for(std::size_t(0), table.primitives.size(), [&](std::size_t i) {
      failure.guard([&] {
        unpack_and_build(i, table.primitives[i], accessors, materials[i]);
        done.add_one();
      });
    });
    failure.rethrow();
  }

  void unpack_and_build(std::size_t index, const Primitive& primitive,
                        std::span<const Accessor> accessors, std::uint32_t material) {
    if (!primitive.draco) return build(index, primitive, accessors, material);
    const UnpackedPrimitive unpacked = unpack_draco(primitive, accessors);
    build(index, unpacked.primitive, unpacked.accessors, material);
  }

  void build(std::size_t index, const Primitive& primitive, std::span<const Accessor> accessors,
             std::uint32_t material) {
    auto [mesh, sources] =
        build_mesh(primitive, accessors, material, scene_.materials, scene_.material_layers, stop_);
    if (primitive.deforms()) {
      scene_.shapes[index] = build_shape(primitive, accessors, mesh, sources);
    }
    scene_.meshes[index] = std::move(mesh);
  }

  const ImportLimits& limits_;
  const ImportOptions& options_;
  const std::stop_token& stop_;
  std::optional<GltfFile> file_;
  ByteBudget budget_;
  TexelBudget texels_;
  ImportTimes times_;
  Warnings warnings_;
  DecodedImages decoded_;
  Scene scene_;
  std::optional<std::uint32_t> default_material_;
};

}  // namespace

Scene import_gltf(const std::filesystem::path& path, const ImportLimits& limits,
                  const ImportOptions& options) {
  try {
    const Stopwatch watch;
    Importer importer(path, path.stem().string(), limits, options);
    Scene scene = importer.import();
    if (options.times) {
      *options.times = importer.times();
      options.times->total = watch.seconds();
    }
    return scene;
  } catch (const std::bad_alloc&) {
    throw ImportError("not enough memory for the scene");
  }
}

Scene import_lone_gltf(RegularFile file, const ImportLimits& limits) {
  try {
    return Importer(std::move(file), {}, limits, ImportOptions()).import();
  } catch (const std::bad_alloc&) {
    throw ImportError("not enough memory for the scene");
  }
}

}  // namespace heliograph::scene
