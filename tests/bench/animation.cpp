// Cost of animating a scene by one frame without rendering: nodes, instances, vertices,
// acceleration structure. One line of JSON per synthetic scene of 100 instances and per file:
// median milliseconds. "processor" is CPU time of all threads, which is robust on a busy machine.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "render/frame/engine_parts.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "scene/animation/deform.hpp"
#include "scene/animation/pose.hpp"
#include "scene/gltf/materials/layer_table.hpp"
#include "scene/import.hpp"

namespace heliograph::bench {
namespace {

struct Options {
  std::vector<std::filesystem::path> scenes;
  std::string device;
  std::string tracer = "auto";
  std::string clip;
  int instances = 100;
  int frames = 200;
};

using Clock = std::chrono::steady_clock;

constexpr float two_pi = glm::two_pi<float>();

/// Upright, of `rings` rings of `sides` quads, 1 m high: 2 * rings * sides triangles.
scene::Mesh column(int rings, int sides) {
  scene::Mesh mesh;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int side = 0; side <= sides; ++side) {
      const float angle = two_pi * float(side) / float(sides);
      shared::Vertex vertex{};
      vertex.normal = {std::cos(angle), 0.0f, std::sin(angle)};
      vertex.position = 0.2f * vertex.normal;
      vertex.position.y = float(ring) / float(rings);
      vertex.tangent = {0.0f, 1.0f, 0.0f, 1.0f};
      mesh.vertices.push_back(vertex);
      mesh.bounds.include(vertex.position);
    }
  }
  const auto index = [&](int ring, int side) {
    return static_cast<std::uint32_t>(ring * (sides + 1) + side);
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int side = 0; side < sides; ++side) {
      for (const std::uint32_t corner :
           {index(ring, side), index(ring + 1, side), index(ring, side + 1), index(ring, side + 1),
            index(ring + 1, side), index(ring + 1, side + 1)}) {
        mesh.indices.push_back(corner);
      }
    }
  }
  return mesh;
}

/// A scene with one material and nothing else.
scene::Scene bare_scene() {
  scene::Scene scene;
  shared::Material material{};
  material.base_color = glm::vec4(1.0f);
  material.roughness = 1.0f;
  for (const auto slot :
       {&shared::Material::base_color_texture, &shared::Material::metallic_roughness_texture,
        &shared::Material::normal_texture, &shared::Material::occlusion_texture,
        &shared::Material::emissive_texture}) {
    (material.*slot).texture = shared::no_texture;
  }
  scene.materials.push_back(material);
  scene.material_names.emplace_back("plain");
  scene.material_layers.emplace_back();
  scene.layers.push_back(scene::plain_layer());
  scene.clips.push_back({"move", 1.0f, {}});
  return scene;
}

std::uint32_t add_node(scene::Scene& scene, const glm::vec3& place,
                       std::optional<std::uint32_t> parent = std::nullopt) {
  scene::Node node;
  node.parent = parent;
  node.transform = scene::Transform{.translation = place};
  node.local = node.transform->matrix();
  node.world = parent ? scene.nodes[*parent].world * node.local : node.local;
  scene.nodes.push_back(node);
  return static_cast<std::uint32_t>(scene.nodes.size() - 1);
}

glm::vec3 place_of(int i) {
  return {float(i % 10), 0.0f, float(i / 10)};
}

/// A swing about the x axis with 60 keys.
scene::Channel swing(std::uint32_t node, float degrees) {
  scene::Channel channel{{.width = 4}, node, scene::Property::rotation};
  for (int key = 0; key <= 60; ++key) {
    const float time = float(key) / 60.0f;
    const float half = 0.5f * glm::radians(degrees) * std::sin(two_pi * time);
    channel.times.push_back(time);
    for (const float value : {std::sin(half), 0.0f, 0.0f, std::cos(half)}) {
      channel.values.push_back(value);
    }
  }
  return channel;
}

scene::Scene rigid_crowd(int count) {
  scene::Scene scene = bare_scene();
  scene.meshes.push_back(column(25, 100));
  for (int i = 0; i < count; ++i) {
    const std::uint32_t node = add_node(scene, place_of(i));
    scene.instances.push_back({0, node});
    scene.clips[0].channels.push_back(swing(node, 30.0f));
  }
  return scene;
}

/// Instances with separate vertices.
void add_deforming(scene::Scene& scene, std::uint32_t node, std::optional<std::uint32_t> skin) {
  const auto mesh = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(column(20, 20));
  scene.deformations.push_back({mesh, 0, node, skin});
  scene.instances.push_back({mesh, node});
}

scene::Scene skinned_crowd(int count) {
  constexpr std::uint32_t joints = 20;
  scene::Scene scene = bare_scene();
  scene::Shape shape{.vertices = column(20, 20).vertices, .joints_per_vertex = 4};
  for (const shared::Vertex& vertex : shape.vertices) {
    const auto joint = std::min(static_cast<std::uint32_t>(vertex.position.y * joints), joints - 1);
    const std::uint32_t next = std::min(joint + 1, joints - 1);
    shape.influences.insert(shape.influences.end(), {{joint, 0.5f}, {next, 0.5f}, {}, {}});
  }
  scene.shapes.push_back(shape);
  const std::uint32_t origin = add_node(scene, glm::vec3(0.0f));
  for (int i = 0; i < count; ++i) {
    scene::Skin skin;
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
      const std::uint32_t node =
          joint == 0 ? add_node(scene, place_of(i))
                     : add_node(scene, {0.0f, 1.0f / joints, 0.0f}, skin.joints.back());
      glm::mat4 inverse_bind(1.0f);
      inverse_bind[3].y = -float(joint) / joints;
      skin.joints.push_back(node);
      skin.inverse_bind.push_back(inverse_bind);
      scene.clips[0].channels.push_back(swing(node, 5.0f));
    }
    scene.skins.push_back(skin);
    add_deforming(scene, origin, static_cast<std::uint32_t>(i));
  }
  return scene;
}

scene::Scene morphed_crowd(int count) {
  scene::Scene scene = bare_scene();
  scene::Shape shape{.vertices = column(20, 20).vertices};
  for (const float wave : {3.0f, 7.0f}) {
    scene::MorphTarget& target = shape.targets.emplace_back();
    for (const shared::Vertex& vertex : shape.vertices) {
      target.positions.push_back(0.1f * std::sin(wave * vertex.position.y) * vertex.normal);
    }
  }
  scene.shapes.push_back(shape);
  for (int i = 0; i < count; ++i) {
    const std::uint32_t node = add_node(scene, place_of(i));
    scene.nodes[node].weights = {0.0f, 0.0f};
    scene::Channel channel{{.width = 2}, node, scene::Property::weights};
    channel.times = {0.0f, 1.0f};
    channel.values = {0.0f, 1.0f, 1.0f, 0.0f};
    scene.clips[0].channels.push_back(channel);
    add_deforming(scene, node, std::nullopt);
  }
  return scene;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

nlohmann::json measure(render::Engine& engine, const std::string& name, scene::Scene whole,
                       const Options& options) {
  const auto scene = std::make_shared<const scene::Scene>(std::move(whole));
  const scene::Clip* const clip =
      options.clip.empty() ? &scene->clips.front() : scene::find_clip(*scene, options.clip);
  if (!clip) throw std::runtime_error(name + ": there is no clip " + options.clip);
  auto& parts = engine.parts();
  render::MovingScene moving(parts.device, *parts.tracer,
                             engine.upload(scene, scene::constant_environment(glm::vec3(1.0f))));
  scene::Pose pose = scene::rest_pose(*scene);
  std::vector<double> whole_times, evaluate_times;
  const std::clock_t spent_before = std::clock();
  for (int frame = 0; frame < options.frames; ++frame) {
    const double seconds = (frame + 0.5) / 60.0;
    const Clock::time_point start = Clock::now();
    moving.set_pose(clip, seconds);
    moving.advance();
    whole_times.push_back(since(start));
  }
  const double spent = 1000.0 * double(std::clock() - spent_before) / CLOCKS_PER_SEC;
  for (int frame = 0; frame < options.frames; ++frame) {
    const Clock::time_point start = Clock::now();
    scene::evaluate(*scene, *clip, (frame + 0.5) / 60.0, pose);
    evaluate_times.push_back(since(start));
  }
  std::uint64_t deforming = 0;
  for (const scene::Deformation& deformation : scene->deformations) {
    deforming += scene->meshes[deformation.mesh].vertices.size();
  }
  return {{"scene", name},
          {"clip", clip->name},
          {"tracer", std::string(protocol::enum_name(engine.tracer()))},
          {"instances", scene->instances.size()},
          {"nodes", scene->nodes.size()},
          {"channels", clip->channels.size()},
          {"triangles", scene->triangle_count()},
          {"deforming_vertices", deforming},
          {"milliseconds", median(whole_times)},
          {"of_that_curves_and_nodes", median(evaluate_times)},
          {"processor", spent / options.frames}};
}

void run(const Options& options) {
  render::Engine engine({.device = options.device, .tracer = options.tracer});
  const auto print = [](const nlohmann::json& line) {
    std::printf("%s\n", line.dump().c_str());
    std::fflush(stdout);
  };
  for (const std::filesystem::path& path : options.scenes) {
    print(measure(engine, path.stem().string(), scene::import_gltf(path), options));
  }
  if (!options.scenes.empty()) return;
  print(measure(engine, "rigid", rigid_crowd(options.instances), options));
  print(measure(engine, "skinned", skinned_crowd(options.instances), options));
  print(measure(engine, "morphed", morphed_crowd(options.instances), options));
}

}  // namespace
}  // namespace heliograph::bench

int main(int count, char** arguments) {
  heliograph::bench::Options options;
  CLI::App app("Times of animating a scene by one frame, milliseconds.");
  app.add_option("scenes", options.scenes, "glTF files with clips; default: synthetic scenes");
  app.add_option("--clip", options.clip, "Clip to play; default: the first");
  app.add_option("--device", options.device, "Part of the name of the Vulkan device to use");
  app.add_option("--tracer", options.tracer, "Ray tracer");
  app.add_option("--instances", options.instances, "Instances of each synthetic scene")
      ->check(CLI::Range(1, 10000));
  app.add_option("--frames", options.frames, "Number of frames")->check(CLI::Range(1, 100000));
  CLI11_PARSE(app, count, arguments);
  try {
    heliograph::bench::run(options);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph-bench-animation: %s\n", failure.what());
    return 1;
  }
  return 0;
}
