#include "fsm/mesh/gltf/gltf_material.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>
#include <span>

#include "fsm/image/colour_space.h"

namespace fsm {
namespace {

using nlohmann::json;

float Share(const json& of, const char* key, double otherwise) {
  return static_cast<float>(std::clamp(JsonNumber(of, key, otherwise), 0.0, 1.0));
}

glm::vec3 ColourOf(const json& of, const char* key, glm::vec3 colour) {
  JsonNumbers(of, key, std::span(&colour.x, 3));
  return glm::clamp(colour, 0.0f, 16.0f);
}

GltfMaterial::Texture ReadTexture(const json& of, const char* key, const char* strength = "") {
  const json& given = JsonMember(of, key);
  return {JsonInteger(given, "index"),
          static_cast<float>(std::clamp(JsonNumber(given, strength, 1), -4.0, 4.0)), &given};
}

/// Sets the cosines between which toon shading changes from shade to light: below -1 + toony -
/// shift it is all shade, above 1 - toony - shift all light (VRMC_materials_mtoon 1.0, "Lighting").
void SetToonEdges(double toony, double shift, PbrMaterial& pbr) {
  pbr.shade_to = static_cast<float>(-1 + toony - shift);
  pbr.light_from = static_cast<float>(1 - toony - shift);
}

void ReadToon(const json& toon, GltfMaterial& out) {
  PbrMaterial& pbr = out.pbr.emplace();
  pbr.kind = PbrMaterial::Kind::kToon;
  pbr.shade_colour = ColourOf(toon, "shadeColorFactor", glm::vec3(1));
  SetToonEdges(std::clamp(JsonNumber(toon, "shadingToonyFactor", 0.9), 0.0, 1.0),
               std::clamp(JsonNumber(toon, "shadingShiftFactor", 0), -1.0, 1.0), pbr);
  out.emissive = ReadTexture(toon, "shadeMultiplyTexture");
}

/// Reads the properties of Unity's MToon shader in VRM 0.x. Its transition is from the shade
/// threshold to that threshold moved towards 1 by 1 - toony; colours are sRGB.
void ReadVrm0Toon(const json& properties, GltfMaterial& out) {
  PbrMaterial& pbr = out.pbr.emplace();
  pbr.kind = PbrMaterial::Kind::kToon;
  const json& numbers = JsonMember(properties, "floatProperties");
  const float shift =
      static_cast<float>(std::clamp(JsonNumber(numbers, "_ShadeShift", 0), -1.0, 1.0));
  pbr.shade_to = shift;
  pbr.light_from = shift + (1 - shift) * (1 - Share(numbers, "_ShadeToony", 0.9));
  pbr.shade_colour = SrgbToLinear(
      ColourOf(JsonMember(properties, "vectorProperties"), "_ShadeColor", glm::vec3(1)));
  out.emissive.index = JsonInteger(JsonMember(properties, "textureProperties"), "_ShadeTexture");
}

const json& Vrm0Properties(const GltfDocument& document, std::int64_t material) {
  static const json none;
  const json& list = JsonMember(JsonMember(JsonMember(document.root(), "extensions"), "VRM"),
                                "materialProperties");
  const auto index = static_cast<std::size_t>(material);
  return material >= 0 && list.is_array() && index < list.size() ? list[index] : none;
}

}  // namespace

GltfMaterial ReadMaterial(const GltfDocument& document, std::int64_t material) {
  GltfMaterial out;
  if (material < 0) return out;
  const json& given = document.At("materials", material);
  const std::string mode = JsonText(given, "alphaMode");
  out.alpha = mode == "MASK"    ? GltfMaterial::Alpha::kMask
              : mode == "BLEND" ? GltfMaterial::Alpha::kBlend
                                : GltfMaterial::Alpha::kOpaque;
  const json& extensions = JsonMember(given, "extensions");
  const json& old = Vrm0Properties(document, material);
  const std::string shader = JsonText(old, "shader");
  // Toon materials are often marked unlit as well, for programs without MToon.
  if (extensions.contains("VRMC_materials_mtoon")) {
    ReadToon(JsonMember(extensions, "VRMC_materials_mtoon"), out);
  } else if (shader == "VRM/MToon") {
    ReadVrm0Toon(old, out);
  } else if (extensions.contains("KHR_materials_unlit") || shader.starts_with("VRM/Unlit")) {
    return out;
  } else {
    PbrMaterial& pbr = out.pbr.emplace();
    const json& metal = JsonMember(given, "pbrMetallicRoughness");
    pbr.metallic = Share(metal, "metallicFactor", 1);
    pbr.roughness = Share(metal, "roughnessFactor", 1);
    out.metallic_roughness = ReadTexture(metal, "metallicRoughnessTexture");
    out.occlusion = ReadTexture(given, "occlusionTexture", "strength");
    out.emissive = ReadTexture(given, "emissiveTexture");
  }
  out.normal = ReadTexture(given, "normalTexture", "scale");
  out.pbr->emissive = ColourOf(given, "emissiveFactor", glm::vec3(0));
  const double strength =
      JsonNumber(JsonMember(extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
  out.pbr->emissive *= static_cast<float>(std::clamp(strength, 0.0, 16.0));
  out.pbr->cut_out = out.alpha != GltfMaterial::Alpha::kOpaque;
  return out;
}

}  // namespace fsm
