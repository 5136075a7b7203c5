#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "scenes/generator/geometry/transforms.hpp"
#include "scenes/generator/scenes/material_balls.hpp"

// Sources of the names and units: the extensions KHR_materials_* of the glTF registry.
namespace heliograph::scenes {
namespace {

using BallValues = std::array<float, balls_per_row>;
using BallColors = std::array<std::pair<const char*, glm::vec3>, balls_per_row>;

constexpr float ball_diameter = 1.0f;  // what a volume calls its thickness
constexpr float nanometres_of_film = 400.0f;
constexpr BallValues fractions = {0.0f, 0.25f, 0.5f, 0.75f, 1.0f};
const BallColors ball_colors = {{{"white", {1.0f, 1.0f, 1.0f}},
                                 {"orange", {1.0f, 0.45f, 0.1f}},
                                 {"green", {0.15f, 0.8f, 0.2f}},
                                 {"blue", {0.1f, 0.3f, 1.0f}},
                                 {"black", {0.0f, 0.0f, 0.0f}}}};

std::string text_of(float value) {
  std::array<char, 16> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

/// `make` gives the material of a value.
template <class Make>
BallRow row_of(const std::string& name, const BallValues& values, const Make& make) {
  BallRow row{name, {}};
  for (const float value : values) {
    row.materials.push_back(make(value));
    row.materials.back().name = name + "=" + text_of(value);
  }
  return row;
}

template <class Make>
BallRow row_of(const std::string& name, const BallColors& values, const Make& make) {
  BallRow row{name, {}};
  for (const auto& [color_name, color] : values) {
    row.materials.push_back(make(color));
    row.materials.back().name = name + "=" + color_name;
  }
  return row;
}

Material plastic(glm::vec3 color, float roughness) {
  Material material;
  material.color = color;
  material.roughness = roughness;
  material.metallic = 0.0f;
  return material;
}

Material metal(glm::vec3 color, float roughness) {
  Material material = plastic(color, roughness);
  material.metallic = 1.0f;
  return material;
}

Material with(Material material, std::string_view extension,
              std::vector<MaterialExtension::Member> members) {
  material.extensions.push_back({"KHR_materials_" + std::string(extension), std::move(members)});
  return material;
}

Material thin_glass(float transmission, float roughness) {
  return with(plastic(glm::vec3(0.9f, 1.0f, 0.95f), roughness), "transmission",
              {{"transmissionFactor", transmission}});
}

/// A solid ball; after `distance` metres white light has the color (0.3, 0.7, 0.9).
Material solid_glass(float roughness, float ior, float distance) {
  Material material =
      with(plastic(glm::vec3(1.0f), roughness), "transmission", {{"transmissionFactor", 1.0f}});
  material = with(std::move(material), "volume",
                  {{"thicknessFactor", ball_diameter},
                   {"attenuationDistance", distance},
                   {"attenuationColor", glm::vec3(0.3f, 0.7f, 0.9f)}});
  return with(std::move(material), "ior", {{"ior", ior}});
}

Material coated(float coat, float roughness) {
  return with(plastic({0.5f, 0.05f, 0.04f}, 0.6f), "clearcoat",
              {{"clearcoatFactor", coat}, {"clearcoatRoughnessFactor", roughness}});
}

Material cloth(glm::vec3 sheen, float roughness) {
  return with(plastic({0.08f, 0.06f, 0.15f}, 0.9f), "sheen",
              {{"sheenColorFactor", sheen}, {"sheenRoughnessFactor", roughness}});
}

/// Without a texture the film is as thick as the maximum. Its ior differs from that of the base, or
/// nothing would interfere.
Material filmed(float film, float nanometres) {
  return with(plastic(glm::vec3(0.04f), 0.1f), "iridescence",
              {{"iridescenceFactor", film},
               {"iridescenceIor", 2.0f},
               {"iridescenceThicknessMaximum", nanometres}});
}

Material brushed(float strength, float degrees) {
  return with(metal({0.9f, 0.9f, 0.92f}, 0.35f), "anisotropy",
              {{"anisotropyStrength", strength}, {"anisotropyRotation", glm::radians(degrees)}});
}

Material leaf(float factor, glm::vec3 color) {
  return with(plastic({0.6f, 0.55f, 0.45f}, 0.7f), "diffuse_transmission",
              {{"diffuseTransmissionFactor", factor}, {"diffuseTransmissionColorFactor", color}});
}

Material glowing(float strength) {
  Material material = plastic(glm::vec3(0.05f), 0.5f);
  material.emission = strength * glm::vec3(1.0f, 0.6f, 0.25f);
  return material;
}

Material veil(float opacity) {
  Material material = plastic({0.1f, 0.35f, 0.6f}, 0.4f);
  material.opacity = opacity;
  return material;
}

/// Dots whose alpha falls from the middle to 0 at the corner of each tile: a cutoff is a size.
Material perforated(float cutoff) {
  TextureRecipe dots;
  dots.name = "dots";
  dots.width = 0.25f * pi * ball_diameter;  // four round the ball
  dots.masked = true;
  dots.sample = [](glm::vec2 uv) {
    SurfaceSample sample;
    sample.color = {0.75f, 0.55f, 0.2f};
    sample.roughness = 0.5f;
    const glm::vec2 wave = glm::cos(two_pi * (uv - 0.5f));
    sample.alpha = 0.5f + 0.25f * (wave.x + wave.y);
    return sample;
  };
  Material material;
  material.texture = std::move(dots);
  material.masked = true;
  material.alpha_cutoff = cutoff;
  material.double_sided = true;
  return material;
}

void add_opaque_rows(std::vector<BallRow>& rows) {
  rows.push_back(row_of("dielectric_roughness", fractions, [](float v) {
    return plastic({0.5f, 0.08f, 0.06f}, v);
  }));
  rows.push_back(row_of("metal_roughness", fractions, [](float v) {
    return metal({1.0f, 0.77f, 0.34f}, v);
  }));
  rows.push_back(row_of("ior", BallValues{1.0f, 1.33f, 1.5f, 1.8f, 2.4f}, [](float v) {
    return with(plastic(glm::vec3(0.05f), 0.1f), "ior", {{"ior", v}});
  }));
  rows.push_back(row_of("specular", fractions, [](float v) {
    return with(plastic(glm::vec3(0.05f), 0.2f), "specular", {{"specularFactor", v}});
  }));
  rows.push_back(row_of("specular_color", ball_colors, [](glm::vec3 v) {
    return with(with(plastic(glm::vec3(0.05f), 0.2f), "ior", {{"ior", 1.8f}}), "specular",
                {{"specularColorFactor", v}});
  }));
  rows.push_back(row_of("clearcoat", fractions, [](float v) { return coated(v, 0.0f); }));
  rows.push_back(row_of("clearcoat_roughness", BallValues{0.0f, 0.1f, 0.25f, 0.5f, 1.0f},
                        [](float v) { return coated(1.0f, v); }));
  rows.push_back(
      row_of("sheen", fractions, [](float v) { return cloth(glm::vec3(v, v, 0.8f * v), 0.3f); }));
  rows.push_back(row_of("sheen_roughness", BallValues{0.1f, 0.25f, 0.5f, 0.75f, 1.0f}, [](float v) {
    return cloth({0.9f, 0.8f, 0.9f}, v);
  }));
  rows.push_back(
      row_of("iridescence", fractions, [](float v) { return filmed(v, nanometres_of_film); }));
  rows.push_back(row_of("iridescence_thickness", BallValues{100.0f, 250.0f, 400.0f, 550.0f, 700.0f},
                        [](float v) { return filmed(1.0f, v); }));
  rows.push_back(row_of("anisotropy", fractions, [](float v) { return brushed(v, 0.0f); }));
  rows.push_back(row_of("anisotropy_rotation", BallValues{0.0f, 30.0f, 60.0f, 90.0f, 135.0f},
                        [](float v) { return brushed(0.9f, v); }));
  rows.push_back(row_of("emission", BallValues{0.25f, 0.5f, 1.0f, 2.0f, 4.0f}, glowing));
}

void add_transparent_rows(std::vector<BallRow>& rows) {
  constexpr BallValues roughness = {0.0f, 0.1f, 0.25f, 0.5f, 0.75f};
  rows.push_back(row_of("transmission", fractions, [](float v) { return thin_glass(v, 0.0f); }));
  rows.push_back(
      row_of("transmission_roughness", roughness, [](float v) { return thin_glass(1.0f, v); }));
  rows.push_back(
      row_of("volume_roughness", roughness, [](float v) { return solid_glass(v, 1.5f, 2.0f); }));
  rows.push_back(row_of("volume_attenuation", BallValues{4.0f, 2.0f, 1.0f, 0.5f, 0.25f},
                        [](float v) { return solid_glass(0.0f, 1.5f, v); }));
  rows.push_back(row_of("volume_ior", BallValues{1.0f, 1.1f, 1.33f, 1.5f, 2.0f},
                        [](float v) { return solid_glass(0.0f, v, 4.0f); }));
  rows.push_back(row_of("dispersion", BallValues{0.0f, 0.5f, 1.0f, 2.0f, 5.0f}, [](float v) {
    return with(solid_glass(0.0f, 1.5f, 4.0f), "dispersion", {{"dispersion", v}});
  }));
  rows.push_back(row_of("diffuse_transmission", fractions, [](float v) {
    return leaf(v, {0.9f, 0.5f, 0.2f});
  }));
  rows.push_back(row_of("diffuse_transmission_color", ball_colors,
                        [](glm::vec3 v) { return leaf(0.75f, v); }));
  rows.push_back(row_of("alpha_blend", BallValues{0.1f, 0.25f, 0.5f, 0.75f, 1.0f}, veil));
  rows.push_back(row_of("alpha_mask", BallValues{0.1f, 0.3f, 0.5f, 0.7f, 0.9f}, perforated));
}

}  // namespace

std::vector<BallRow> ball_rows() {
  std::vector<BallRow> rows;
  add_opaque_rows(rows);
  add_transparent_rows(rows);
  return rows;
}

}  // namespace heliograph::scenes
