#include "fsm/mesh/gltf/gltf_textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>
#include <span>

#include "fsm/image/byte_order.h"
#include "fsm/image/colour_space.h"
#include "fsm/image/image_codec.h"
#include "fsm/image/shrink.h"
#include "fsm/mesh/texture_atlas.h"
#include "vm_protocol/core/lower_case.h"

namespace fsm {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxPictures = 64;
constexpr std::size_t kMaxDetailed = 16;  // materials with textures beside their picture
constexpr int kOpaque = -1, kSmooth = 256;

glm::vec4 BaseColourFactor(const json& material) {
  glm::vec4 factor(1);
  JsonNumbers(JsonMember(material, "pbrMetallicRoughness"), "baseColorFactor",
              std::span(&factor.x, 4));
  return glm::clamp(factor, 0.0f, 1.0f);
}

const json& BaseColourTexture(const json& material) {
  return JsonMember(JsonMember(material, "pbrMetallicRoughness"), "baseColorTexture");
}

/// Returns, for each sRGB byte, the byte multiplied by a factor in linear light.
std::array<std::uint8_t, 256> ScaledBytes(float factor) {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float shown = static_cast<float>(i) / 255;
    const float out = LinearToSrgb(factor * SrgbToLinear(shown));
    table[i] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(out, 0.0f, 1.0f)));
  }
  return table;
}

void ApplyFactor(Image& picture, glm::vec4 factor, int cut) {
  const std::array<std::array<std::uint8_t, 256>, 3> dim{
      ScaledBytes(factor.r), ScaledBytes(factor.g), ScaledBytes(factor.b)};
  for (std::size_t i = 0; i + 3 < picture.rgba.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) picture.rgba[i + c] = dim[c][picture.rgba[i + c]];
    const float alpha = factor.a * static_cast<float>(picture.rgba[i + 3]);
    picture.rgba[i + 3] =
        cut == kOpaque   ? 255
        : cut == kSmooth ? static_cast<std::uint8_t>(std::lround(alpha))
                         : static_cast<std::uint8_t>(alpha >= static_cast<float>(cut) ? 255 : 0);
  }
}

GltfUvTransform UvOf(const json& texture) {
  GltfUvTransform uv;
  uv.set = JsonInteger(texture, "texCoord", 0);
  const json& by = JsonMember(JsonMember(texture, "extensions"), "KHR_texture_transform");
  uv.set = JsonInteger(by, "texCoord", uv.set);
  JsonNumbers(by, "offset", std::span(&uv.offset.x, 2));
  JsonNumbers(by, "scale", std::span(&uv.scale.x, 2));
  uv.rotation_rad = static_cast<float>(JsonNumber(by, "rotation", 0));
  return uv;
}

Image Resized(Image image, int width, int height) {
  if (image.width == width && image.height == height) return image;
  Image out{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t from = 4 * image.Index(x * image.width / width, y * image.height / height);
      out.rgba.insert(out.rgba.end(), &image.rgba[from], &image.rgba[from] + 4);
    }
  }
  return out;
}

/// Scales two pictures to one size: the larger width and the larger height of the two. A missing
/// picture is filled with the colour that stands for it, `a_default` or `b_default`. Returns
/// false, and changes nothing, if both are missing.
bool ToOneSize(std::optional<Image>& a, std::optional<Image>& b,
               const std::array<std::uint8_t, 4>& a_default,
               const std::array<std::uint8_t, 4>& b_default) {
  if (!a && !b) return false;
  if (!a) a = Image{1, 1, {a_default.begin(), a_default.end()}};
  if (!b) b = Image{1, 1, {b_default.begin(), b_default.end()}};
  const int width = std::max(a->width, b->width), height = std::max(a->height, b->height);
  a = Resized(std::move(*a), width, height);
  b = Resized(std::move(*b), width, height);
  return true;
}

}  // namespace

glm::vec2 GltfUvTransform::operator()(glm::vec2 uv) const {
  const float c = std::cos(rotation_rad), s = std::sin(rotation_rad);
  const glm::vec2 scaled = scale * uv;
  return offset + glm::vec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x);
}

GltfUvTransform GltfTextures::UvOfMaterial(std::int64_t material) const {
  const json& base = BaseColourTexture(document_.At("materials", material));
  if (base.contains("index")) return UvOf(base);
  const GltfMaterial given = ReadMaterial(document_, material);
  for (const auto* one :
       {&given.normal, &given.metallic_roughness, &given.occlusion, &given.emissive}) {
    if (one->index >= 0 && one->reference) return UvOf(*one->reference);
  }
  return {};
}

std::int64_t GltfTextures::ImageOf(std::int64_t texture) {
  const json& given = document_.At("textures", texture);
  if (const std::int64_t own = JsonInteger(given, "source"); own >= 0) return own;
  for (const char* kind : {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif"}) {
    const std::int64_t other =
        JsonInteger(JsonMember(JsonMember(given, "extensions"), kind), "source");
    if (other >= 0) return other;
  }
  return -1;
}

void GltfTextures::ApplyMaterial(std::int64_t index, ImportedHead::Part& part) {
  using Alpha = GltfMaterial::Alpha;
  const json& material = document_.At("materials", index);
  part.name += " " + JsonText(material, "name");
  const glm::vec4 factor = BaseColourFactor(material);
  if (index >= 0) part.colour = glm::vec3(factor);
  part.two_sided = material.contains("doubleSided") && material["doubleSided"] == json(true);
  const GltfMaterial given = ReadMaterial(document_, index);
  part.cut_out = given.alpha != Alpha::kOpaque;
  if (given.pbr) {
    const auto [known, fresh] =
        pbr_index_.try_emplace(index, static_cast<int>(head_.pbr_materials.size()));
    if (fresh) head_.pbr_materials.push_back(*given.pbr);
    part.pbr = known->second;
  }
  const std::int64_t texture = JsonInteger(BaseColourTexture(material), "index");
  const bool detailed = given.normal.index >= 0 || given.metallic_roughness.index >= 0 ||
                        given.occlusion.index >= 0 || given.emissive.index >= 0;
  if (texture < 0 && !detailed) return;
  const double cut_off = std::clamp(JsonNumber(material, "alphaCutoff", 0.5), 0.0, 1.0);
  const int cut = given.alpha == Alpha::kMask    ? static_cast<int>(std::lround(255 * cut_off))
                  : given.alpha == Alpha::kBlend ? kSmooth
                                                 : kOpaque;
  std::uint32_t steps = 0;
  for (int k = 0; k < 4; ++k) {
    steps = steps << 8 | static_cast<std::uint32_t>(std::lround(255 * factor[k]));
  }
  const Key key{texture < 0 ? -1 : ImageOf(texture), steps, cut, detailed ? index : -1};
  if (const auto known = picture_of_.find(key); known != picture_of_.end()) {
    part.base_colour = known->second;
    return;
  }
  part.base_colour = Picture(
      key, factor, detailed ? DetailOf(given, UvOfMaterial(index)) : ImportedHead::Detail{});
}

std::optional<Image> GltfTextures::Decode(std::int64_t image) {
  const auto left_out = [&](const std::string& why) {
    head_.notices.push_back("images[" + std::to_string(image) + "] is left out: " + why);
    return std::nullopt;
  };
  try {
    auto picture = DecodePngOrJpeg(BytesOf(document_.ImageBytes(image)));
    if (!picture) return left_out(picture.error().text);
    HalveUntil(*picture, TextureAtlas::kMaxSide);
    return std::move(*picture);
  } catch (const vm::Failure& failure) {
    return left_out(head_.name + ": " + failure.error.text);
  }
}

ImportedHead::Detail GltfTextures::DetailOf(const GltfMaterial& given, const GltfUvTransform& uv) {
  ImportedHead::Detail detail;
  if (++detailed_ > kMaxDetailed) {
    if (detailed_ == kMaxDetailed + 1) {
      head_.notices.push_back("pictures of light of more than " + std::to_string(kMaxDetailed) +
                              " materials are left out");
    }
    return detail;
  }
  const auto read = [&](const GltfMaterial::Texture& texture) -> std::optional<Image> {
    if (texture.index < 0) return std::nullopt;
    if (texture.reference && UvOf(*texture.reference) != uv) {
      head_.notices.push_back("textures[" + std::to_string(texture.index) +
                              "] is left out: it lies on the mesh otherwise than the colour");
      return std::nullopt;
    }
    return Decode(ImageOf(texture.index));
  };
  auto normal = read(given.normal), metallic_roughness = read(given.metallic_roughness);
  if (ToOneSize(normal, metallic_roughness, {128, 128, 255, 255}, {255, 255, 255, 255})) {
    const auto scaled = [&](std::uint8_t byte) {
      const float slope = given.normal.strength * (static_cast<float>(byte) - 128);
      return static_cast<std::uint8_t>(std::clamp(128 + slope, 1.0f, 255.0f));
    };
    for (std::size_t i = 0; i < normal->rgba.size(); i += 4) {
      std::uint8_t* n = &normal->rgba[i];
      n[0] = scaled(n[0]);
      n[1] = scaled(n[1]);
      n[2] = metallic_roughness->rgba[i + 1];
      n[3] = metallic_roughness->rgba[i + 2];
    }
    detail.normal_roughness_metal = std::move(*normal);
  }
  auto emissive = read(given.emissive), occlusion = read(given.occlusion);
  if (ToOneSize(emissive, occlusion, {255, 255, 255, 255}, {255, 255, 255, 255})) {
    for (std::size_t i = 0; i < emissive->rgba.size(); i += 4) {
      const float shut = given.occlusion.strength * static_cast<float>(255 - occlusion->rgba[i]);
      emissive->rgba[i + 3] = static_cast<std::uint8_t>(std::clamp(255 - shut, 0.0f, 255.0f));
    }
    detail.emission_openness = std::move(*emissive);
  }
  return detail;
}

int GltfTextures::Picture(const Key& key, glm::vec4 factor, ImportedHead::Detail detail) {
  int& known = picture_of_.emplace(key, -1).first->second;
  if (head_.base_colours.size() >= kMaxPictures) return known;
  // If a picture cannot be read, the part keeps its colour; its shape is still shown.
  std::optional<Image> picture;
  if (const std::int64_t image = std::get<0>(key); image >= 0) {
    picture = Decode(image);
  } else {
    const Image& larger = detail.normal_roughness_metal.width > detail.emission_openness.width
                              ? detail.normal_roughness_metal
                              : detail.emission_openness;
    if (larger.width > 0) {
      picture =
          Image{larger.width, larger.height, std::vector<std::uint8_t>(larger.rgba.size(), 255)};
    }
  }
  if (!picture) return known;
  ApplyFactor(*picture, factor, std::get<2>(key));
  known = static_cast<int>(head_.base_colours.size());
  head_.base_colours.push_back(std::move(*picture));
  if (!detail.normal_roughness_metal.rgba.empty() || !detail.emission_openness.rgba.empty()) {
    head_.details.resize(head_.base_colours.size());
    head_.details.back() = std::move(detail);
  }
  return known;
}

}  // namespace fsm
