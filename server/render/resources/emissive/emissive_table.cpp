#include "render/resources/emissive/emissive_table.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>

#include "render/resources/alias_table.hpp"

namespace heliograph::render {
namespace {

constexpr glm::vec3 luminance_of(0.2126f, 0.7152f, 0.0722f);

bool is_light(const shared::Material& material) {
  return (material.flags & shared::material_unlit) == 0 &&
         glm::dot(material.emissive, luminance_of) > 0.0f;
}

/// An instance that shines, triangle by triangle.
struct Shining {
  std::uint32_t instance = 0;
  std::vector<double> powers;
  double power = 0.0;

  double mean() const { return power / static_cast<double>(powers.size()); }
};

void measure(const EmissiveScene& from, Shining& shining) {
  const std::uint32_t number = from.scene.instances[shining.instance].mesh;
  const scene::Mesh& mesh = from.scene.meshes[number];
  const shared::Material& material = from.materials[mesh.material];
  const glm::mat3 linear(from.worlds[shining.instance]);
  const std::span<const glm::vec3> means = from.means.of_mesh(number);
  const bool both = (material.flags & shared::material_double_sided) != 0;
  const float of_area = 0.5f * glm::pi<float>() * (both ? 2.0f : 1.0f);
  shining.powers.resize(mesh.indices.size() / 3);
  for (std::size_t i = 0; i < shining.powers.size(); ++i) {
    const auto corner = [&](std::size_t k) {
      return mesh.vertices[mesh.indices[3 * i + k]].position;
    };
    const glm::vec3 a = corner(0);
    const float area = glm::length(glm::cross(linear * (corner(1) - a), linear * (corner(2) - a)));
    const glm::vec3 mean = means.empty() ? glm::vec3(1.0f) : means[i];
    const float power = area * of_area * glm::dot(material.emissive * mean, luminance_of);
    shining.powers[i] = std::isfinite(power) ? power : 0.0;
    shining.power += shining.powers[i];
  }
}

/// Every instance that shines, in order.
std::vector<Shining> find_shining(const EmissiveScene& from) {
  std::vector<Shining> all;
  for (std::uint32_t i = 0; i < from.scene.instances.size(); ++i) {
    const scene::Mesh& mesh = from.scene.meshes[from.scene.instances[i].mesh];
    if (is_light(from.materials[mesh.material]) && !mesh.indices.empty()) all.push_back({i, {}});
  }
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) { measure(from, all[i]); });
  std::erase_if(all, [](const Shining& one) { return one.power <= 0.0; });
  return all;
}

void keep_strongest(std::vector<Shining>& all, std::size_t most) {
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return all[a].mean() > all[b].mean(); });
  std::size_t count = 0;
  for (const std::size_t i : order) {
    if (count + all[i].powers.size() > most) {
      all[i].powers.clear();
    } else {
      count += all[i].powers.size();
    }
  }
  std::erase_if(all, [](const Shining& one) { return one.powers.empty(); });
}

}  // namespace

EmissiveTable make_emissive_table(const EmissiveScene& from, std::size_t most) {
  std::vector<Shining> all = find_shining(from);
  keep_strongest(all, most);
  EmissiveTable table;
  table.first.assign(from.scene.instances.size(), shared::no_emissive);
  if (all.empty()) return table;
  std::vector<double> powers;
  double total = 0.0;
  for (const Shining& one : all) {
    table.first[one.instance] = static_cast<std::uint32_t>(powers.size());
    powers.insert(powers.end(), one.powers.begin(), one.powers.end());
    total += one.power;
  }
  table.header.count = static_cast<std::uint32_t>(powers.size());
  table.header.power = static_cast<float>(total);
  const std::vector<Alias> slots = make_alias_table(powers);
  table.triangles.reserve(powers.size());
  for (const Shining& one : all) {
    for (std::uint32_t i = 0; i < one.powers.size(); ++i) {
      const Alias& slot = slots[table.triangles.size()];
      const auto share = static_cast<float>(one.powers[i] / total);
      table.triangles.push_back({one.instance, i, share, slot.threshold, slot.item});
    }
  }
  return table;
}

std::size_t emissive_capacity(const scene::Scene& scene,
                              std::span<const shared::Material> materials, std::size_t most) {
  std::size_t count = 0;
  for (const scene::Instance& instance : scene.instances) {
    const scene::Mesh& mesh = scene.meshes[instance.mesh];
    if (is_light(materials[mesh.material])) count += mesh.indices.size() / 3;
  }
  return std::min(count, most);
}

bool same_emission(std::span<const shared::Material> a, std::span<const shared::Material> b) {
  constexpr std::uint32_t sides = shared::material_unlit | shared::material_double_sided;
  return std::ranges::equal(a, b, [](const shared::Material& x, const shared::Material& y) {
    return x.emissive == y.emissive && (x.flags & sides) == (y.flags & sides);
  });
}

float area_scale(const glm::mat4& world) {
  const glm::vec3 x(world[0]), y(world[1]), z(world[2]);
  return glm::length(glm::vec3(glm::length(glm::cross(x, y)), glm::length(glm::cross(y, z)),
                               glm::length(glm::cross(z, x))));
}

}  // namespace heliograph::render
