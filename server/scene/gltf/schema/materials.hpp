#pragma once

// The table of glTF's materials, textures and samplers, and of their extensions.

#include "scene/gltf/schema/schema.hpp"

namespace heliograph::scene::schema {

inline constexpr std::uint32_t wrap_modes[] = {33071, 33648, 10497};
inline constexpr Choices wraps = {.numbers = wrap_modes, .reason = "is not a wrapping mode"};
inline constexpr std::uint32_t magnify_modes[] = {9728, 9729};
inline constexpr Choices magnifications = {.numbers = magnify_modes,
                                           .reason = "is not a magnification filter"};
inline constexpr std::uint32_t minify_modes[] = {9728, 9729, 9984, 9985, 9986, 9987};
inline constexpr Choices minifications = {.numbers = minify_modes,
                                          .reason = "is not a minification filter"};
inline constexpr Member sampler_members[] = {
    integer("wrapS").one_of(wraps),
    integer("wrapT").one_of(wraps),
    integer("magFilter").one_of(magnifications),
    integer("minFilter").one_of(minifications),
};
inline constexpr ObjectType sampler = {sampler_members};

// An empty object is common: the texture's own source is used then.
inline constexpr Member source_members[] = {index("source", Table::images)};
inline constexpr ObjectType source = {source_members};
inline constexpr Extension texture_extensions[] = {
    {"EXT_texture_webp", &source},
    {"KHR_texture_basisu", &source},
};
inline constexpr Member texture_members[] = {
    index("source", Table::images),
    index("sampler", Table::samplers),
};
inline constexpr ObjectType texture = {texture_members, texture_extensions};

inline constexpr Member transform_members[] = {
    numbers("offset", 2),
    number("rotation"),
    numbers("scale", 2),
    integer("texCoord"),
};
inline constexpr ObjectType transform = {transform_members};
inline constexpr Extension slot_extensions[] = {{"KHR_texture_transform", &transform}};
inline constexpr Member slot_members[] = {
    index("index", Table::textures).needed(),
    integer("texCoord"),
};
inline constexpr ObjectType slot = {slot_members, slot_extensions};
inline constexpr Member normal_slot_members[] = {
    index("index", Table::textures).needed(),
    integer("texCoord"),
    number("scale"),
};
inline constexpr ObjectType normal_slot = {normal_slot_members, slot_extensions};
inline constexpr Member occlusion_slot_members[] = {
    index("index", Table::textures).needed(),
    integer("texCoord"),
    number("strength").clamp(0, 1),
};
inline constexpr ObjectType occlusion_slot = {occlusion_slot_members, slot_extensions};

// Factors outside 0..1 are common in files and harmless in the core material.
inline constexpr Member metallic_roughness_members[] = {
    numbers("baseColorFactor", 4).clamp(0, 1), object("baseColorTexture", slot),
    number("metallicFactor").clamp(0, 1),      number("roughnessFactor").clamp(0, 1),
    object("metallicRoughnessTexture", slot),
};
inline constexpr ObjectType metallic_roughness = {metallic_roughness_members};

inline constexpr Member specular_glossiness_members[] = {
    numbers("diffuseFactor", 4).clamp(0, 1),   object("diffuseTexture", slot),
    numbers("specularFactor", 3).clamp(0, 1),  number("glossinessFactor").clamp(0, 1),
    object("specularGlossinessTexture", slot),
};
inline constexpr ObjectType specular_glossiness = {specular_glossiness_members};

inline constexpr Member anisotropy_members[] = {
    number("anisotropyStrength").range(0, 1),
    number("anisotropyRotation"),
    object("anisotropyTexture", slot),
};
inline constexpr ObjectType anisotropy = {anisotropy_members};

inline constexpr Member clearcoat_members[] = {
    number("clearcoatFactor").range(0, 1),          object("clearcoatTexture", slot),
    number("clearcoatRoughnessFactor").range(0, 1), object("clearcoatRoughnessTexture", slot),
    object("clearcoatNormalTexture", normal_slot),
};
inline constexpr ObjectType clearcoat = {clearcoat_members};

inline constexpr Member diffuse_transmission_members[] = {
    number("diffuseTransmissionFactor").range(0, 1),
    object("diffuseTransmissionTexture", slot),
    numbers("diffuseTransmissionColorFactor", 3).range(0, 1),
    object("diffuseTransmissionColorTexture", slot),
};
inline constexpr ObjectType diffuse_transmission = {diffuse_transmission_members};

inline constexpr Member dispersion_members[] = {number("dispersion").at_least(0)};
inline constexpr ObjectType dispersion = {dispersion_members};

inline constexpr Member emissive_strength_members[] = {number("emissiveStrength").at_least(0)};
inline constexpr ObjectType emissive_strength = {emissive_strength_members};

inline constexpr Member ior_members[] = {number("ior").at_least(0)};
inline constexpr ObjectType ior = {ior_members};

inline constexpr Member iridescence_members[] = {
    number("iridescenceFactor").range(0, 1),
    object("iridescenceTexture", slot),
    number("iridescenceIor").at_least(1),
    number("iridescenceThicknessMinimum").at_least(0),
    number("iridescenceThicknessMaximum").at_least(0),
    object("iridescenceThicknessTexture", slot),
};
inline constexpr ObjectType iridescence = {iridescence_members};

inline constexpr Member sheen_members[] = {
    numbers("sheenColorFactor", 3).range(0, 1),
    object("sheenColorTexture", slot),
    number("sheenRoughnessFactor").range(0, 1),
    object("sheenRoughnessTexture", slot),
};
inline constexpr ObjectType sheen = {sheen_members};

inline constexpr Member specular_members[] = {
    number("specularFactor").range(0, 1),
    object("specularTexture", slot),
    numbers("specularColorFactor", 3).at_least(0),
    object("specularColorTexture", slot),
};
inline constexpr ObjectType specular = {specular_members};

inline constexpr Member transmission_members[] = {
    number("transmissionFactor").range(0, 1),
    object("transmissionTexture", slot),
};
inline constexpr ObjectType transmission = {transmission_members};

inline constexpr Member volume_members[] = {
    number("thicknessFactor").at_least(0),
    object("thicknessTexture", slot),
    number("attenuationDistance").above(0),
    numbers("attenuationColor", 3).range(0, 1),
};
inline constexpr ObjectType volume = {volume_members};

inline constexpr ObjectType unlit = {};

inline constexpr Extension material_extensions[] = {
    {"KHR_materials_anisotropy", &anisotropy},
    {"KHR_materials_clearcoat", &clearcoat},
    {"KHR_materials_diffuse_transmission", &diffuse_transmission},
    {"KHR_materials_dispersion", &dispersion},
    {"KHR_materials_emissive_strength", &emissive_strength},
    {"KHR_materials_ior", &ior},
    {"KHR_materials_iridescence", &iridescence},
    {"KHR_materials_pbrSpecularGlossiness", &specular_glossiness},
    {"KHR_materials_sheen", &sheen},
    {"KHR_materials_specular", &specular},
    {"KHR_materials_transmission", &transmission},
    {"KHR_materials_unlit", &unlit},
    {"KHR_materials_volume", &volume},
};
inline constexpr std::string_view alpha_mode_words[] = {"OPAQUE", "MASK", "BLEND"};
inline constexpr Choices alpha_modes = {.words = alpha_mode_words,
                                        .reason = "is not OPAQUE, MASK or BLEND"};
// Old exporters write emissive factors above one: accepted, but not negative ones.
inline constexpr Member material_members[] = {
    text("name"),
    object("pbrMetallicRoughness", metallic_roughness),
    object("normalTexture", normal_slot),
    object("occlusionTexture", occlusion_slot),
    object("emissiveTexture", slot),
    numbers("emissiveFactor", 3).at_least(0),
    text("alphaMode").one_of(alpha_modes),
    number("alphaCutoff").at_least(0),
    boolean("doubleSided"),
};
inline constexpr ObjectType material = {material_members, material_extensions};

}  // namespace heliograph::scene::schema
