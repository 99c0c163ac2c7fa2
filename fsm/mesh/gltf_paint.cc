#include "fsm/mesh/gltf_paint.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fsm/mesh/picture_sheet.h"
#include "fsm/render/image_codec.h"

namespace fsm {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxPictures = 64;
constexpr int kOpaque = -1, kSmooth = 256;

glm::vec4 FactorOf(const json& material) {
  glm::vec4 factor(1);
  const json& given = PartOf(PartOf(material, "pbrMetallicRoughness"), "baseColorFactor");
  for (std::size_t k = 0; k < 4 && given.is_array() && k < given.size(); ++k) {
    if (given[k].is_number())
      factor[static_cast<int>(k)] = std::clamp(given[k].get<float>(), 0.0f, 1.0f);
  }
  return factor;
}

const json& TextureOf(const json& material) {
  return PartOf(PartOf(material, "pbrMetallicRoughness"), "baseColorTexture");
}

/// A picture's byte times a factor of light; both ways by the curve of sRGB (IEC 61966-2-1).
std::array<std::uint8_t, 256> Dimmed(float factor) {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float shown = static_cast<float>(i) / 255;
    const float light =
        factor * (shown <= 0.04045f ? shown / 12.92f : std::pow((shown + 0.055f) / 1.055f, 2.4f));
    const float out =
        light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1 / 2.4f) - 0.055f;
    table[i] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(out, 0.0f, 1.0f)));
  }
  return table;
}

void Paint(Image& picture, glm::vec4 factor, int cut) {
  const std::array<std::array<std::uint8_t, 256>, 3> dim{Dimmed(factor.r), Dimmed(factor.g),
                                                         Dimmed(factor.b)};
  for (std::size_t i = 0; i + 3 < picture.rgba.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) picture.rgba[i + c] = dim[c][picture.rgba[i + c]];
    const float alpha = factor.a * static_cast<float>(picture.rgba[i + 3]);
    picture.rgba[i + 3] =
        cut == kOpaque   ? 255
        : cut == kSmooth ? static_cast<std::uint8_t>(std::lround(alpha))
                         : static_cast<std::uint8_t>(alpha >= static_cast<float>(cut) ? 255 : 0);
  }
}

}  // namespace

glm::vec2 GltfUv::operator()(glm::vec2 uv) const {
  const float c = std::cos(turn_rad), s = std::sin(turn_rad);
  const glm::vec2 at = size * uv;
  return move + glm::vec2(c * at.x + s * at.y, c * at.y - s * at.x);
}

GltfUv GltfPaint::Place(std::int64_t material) const {
  const json& texture = TextureOf(document_.At("materials", material));
  GltfUv uv;
  uv.set = WholeOf(texture, "texCoord", 0);
  const json& by = PartOf(PartOf(texture, "extensions"), "KHR_texture_transform");
  uv.set = WholeOf(by, "texCoord", uv.set);
  const auto pair = [&by](const char* key, glm::vec2 otherwise) {
    const json& list = PartOf(by, key);
    for (std::size_t k = 0; k < 2 && list.is_array() && k < list.size(); ++k) {
      if (list[k].is_number()) otherwise[static_cast<int>(k)] = list[k].get<float>();
    }
    return otherwise;
  };
  uv.move = pair("offset", uv.move);
  uv.size = pair("scale", uv.size);
  uv.turn_rad = static_cast<float>(RealOf(by, "rotation", 0));
  return uv;
}

std::int64_t GltfPaint::ImageOf(std::int64_t texture) {
  const json& given = document_.At("textures", texture);
  if (const std::int64_t own = WholeOf(given, "source"); own >= 0) return own;
  for (const char* kind : {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif"}) {
    const std::int64_t other = WholeOf(PartOf(PartOf(given, "extensions"), kind), "source");
    if (other >= 0) return other;
  }
  return -1;
}

void GltfPaint::Dress(std::int64_t index, HeadFile::Part& part) {
  const json& material = document_.At("materials", index);
  std::string name = TextOf(material, "name");
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  part.name += " " + name;
  const glm::vec4 factor = FactorOf(material);
  if (index >= 0) part.colour = glm::vec3(factor);
  const std::string mode = TextOf(material, "alphaMode");
  part.cut_out = mode == "MASK" || mode == "BLEND";
  part.two_sided = material.contains("doubleSided") && material["doubleSided"] == json(true);
  const std::int64_t texture = WholeOf(TextureOf(material), "index");
  if (texture < 0) return;
  const double cut_off = std::clamp(RealOf(material, "alphaCutoff", 0.5), 0.0, 1.0);
  const int cut = mode == "MASK"    ? static_cast<int>(std::lround(255 * cut_off))
                  : mode == "BLEND" ? kSmooth
                                    : kOpaque;
  std::uint32_t steps = 0;
  for (int k = 0; k < 4; ++k) {
    steps = steps << 8 | static_cast<std::uint32_t>(std::lround(255 * factor[k]));
  }
  part.picture = Picture({ImageOf(texture), steps, cut}, factor);
}

int GltfPaint::Picture(const Key& key, glm::vec4 factor) {
  const auto [known, fresh] = picture_of_.try_emplace(key, -1);
  if (!fresh || head_.pictures.size() >= kMaxPictures) return known->second;
  // A picture that cannot be read leaves the colour; the form is still worth showing.
  const std::int64_t image = std::get<0>(key);
  const auto bytes = document_.ImageBytes(image);
  std::string why = bytes ? "" : bytes.error().text;
  std::optional<Image> picture;
  if (bytes) {
    picture =
        DecodePicture({reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()}, why);
  }
  if (!picture) {
    head_.notices.push_back("images[" + std::to_string(image) + "] is left out: " + why);
    return -1;
  }
  Shrink(*picture, PictureSheet::kMaxSide);
  Paint(*picture, factor, std::get<2>(key));
  known->second = static_cast<int>(head_.pictures.size());
  head_.pictures.push_back(std::move(*picture));
  return known->second;
}

}  // namespace fsm
