#include "render/resources/lights/light_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "render/kernels/common/parallel.hpp"

namespace heliograph::render {
namespace {

static_assert(sizeof(shared::LightGridHeader) == light_texel * shared::texels_per_light_header);
static_assert(sizeof(shared::LightEntry) == light_texel &&
              sizeof(shared::LightSlot) == light_texel);

std::size_t count_punctual(std::span<const shared::Light> lights) {
  return static_cast<std::size_t>(std::ranges::count_if(lights, is_punctual));
}

/// What may be lit and lies near enough to the lights that it matters which is which.
scene::Bounds lit_bounds(std::span<const shared::Light> lights, const scene::Bounds& scene) {
  scene::Bounds places;
  for (const shared::Light& light : lights) {
    if (is_punctual(light)) places.include(light.position);
  }
  const glm::vec3 margin(0.5f * places.radius() + 1e-3f);
  scene::Bounds lit;
  lit.minimum = glm::max(places.minimum - margin, scene.minimum);
  lit.maximum = glm::min(places.maximum + margin, scene.maximum);
  if (glm::any(glm::greaterThan(lit.minimum, lit.maximum))) return places;
  return lit;
}

/// Cubes, as many as there may be.
void divide_into_cells(const scene::Bounds& box, shared::LightGridHeader& header) {
  const glm::vec3 size = glm::max(box.maximum - box.minimum, glm::vec3(1e-3f));
  float edge = std::cbrt(size.x * size.y * size.z / float{shared::most_light_cells});
  for (;; edge *= 1.05f) {
    // A little larger, so that surfaces on the border belong to it.
    const glm::vec3 cells = glm::floor(size * 1.0001f / edge) + 1.0f;
    if (cells.x * cells.y * cells.z > float{shared::most_light_cells}) continue;
    header.cells = glm::uvec3(cells);
    header.inverse_size = 1.0f / edge;
    header.origin = 0.5f * (box.minimum + box.maximum) - 0.5f * edge * cells;
    return;
  }
}

LightBox cell_box(const shared::LightGridHeader& header, std::uint32_t cell) {
  const glm::uvec3 n = header.cells;
  const glm::vec3 at(glm::uvec3(cell % n.x, cell / n.x % n.y, cell / (n.x * n.y)));
  const float edge = 1.0f / header.inverse_size, tolerance = 1e-3f * edge;
  const glm::vec3 low = header.origin + at * edge;
  return {low - tolerance, low + edge + tolerance};
}

/// What lies beyond the grid may be anywhere.
LightBox everywhere(const LightTree& tree) {
  const LightBox& lights = tree.nodes()[0].box;
  return {lights.low - 1e6f, lights.high + 1e6f};
}

void write_entries(const LightTree& tree, const shared::LightGridHeader& header,
                   shared::LightEntry* entries) {
  const std::uint32_t cells = header.cells.x * header.cells.y * header.cells.z;
  const float near = 0.25f / header.inverse_size;
  constexpr int grain = 64;
  kernels::for_each_range(static_cast<int>(cells) + 1, grain, [&](int first, int last) {
    std::array<shared::LightEntry, shared::most_light_entries> found;
    for (auto cell = static_cast<std::uint32_t>(first); cell < static_cast<std::uint32_t>(last);
         ++cell) {
      const LightBox box = cell < cells ? cell_box(header, cell) : everywhere(tree);
      const std::size_t count = tree.cut(box, near, found);
      if (count < found.size()) found[count] = {};
      std::ranges::copy(found, entries + cell * shared::most_light_entries);
    }
  });
}

}  // namespace

bool needs_light_grid(std::span<const shared::Light> lights) {
  return count_punctual(lights) >= shared::least_grid_lights;
}

std::size_t light_grid_texels(std::span<const shared::Light> lights) {
  return shared::texels_per_light_header +
         (shared::most_light_cells + 1) * shared::most_light_entries +
         LightTree::most_slots(count_punctual(lights)) + lights.size();
}

void write_light_grid(std::span<const shared::Light> lights, const scene::Bounds& bounds,
                      std::byte* table, std::size_t first) {
  const LightTree tree(lights);
  std::vector<glm::uvec4> outside;
  shared::LightGridHeader header{};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    header.has_spots |= lights[i].type == shared::light_spot ? 1u : 0u;
    if (!is_punctual(lights[i])) outside.emplace_back(static_cast<std::uint32_t>(i), 0, 0, 0);
  }
  divide_into_cells(lit_bounds(lights, bounds), header);
  const std::uint32_t lists = header.cells.x * header.cells.y * header.cells.z + 1;
  header.slot_count = static_cast<std::uint32_t>(tree.slots().size());
  header.outside_count = static_cast<std::uint32_t>(outside.size());
  header.first_entry = static_cast<std::uint32_t>(first) + shared::texels_per_light_header;
  header.first_slot = header.first_entry + lists * shared::most_light_entries;
  header.first_outside = header.first_slot + header.slot_count;
  std::memcpy(table + first * light_texel, &header, sizeof header);
  write_entries(tree, header,
                reinterpret_cast<shared::LightEntry*>(table + header.first_entry * light_texel));
  std::ranges::copy(std::as_bytes(tree.slots()), table + header.first_slot * light_texel);
  std::ranges::copy(std::as_bytes(std::span(outside)), table + header.first_outside * light_texel);
}

}  // namespace heliograph::render
