#include "fsm/render/head_textures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fsm/image/shrink.h"
#include "fsm/render/texture_unit.h"

namespace fsm {
namespace {

/// Returns an RGBA picture at twice its size, with linear interpolation.
Image Doubled(const Image& image) {
  Image out{2 * image.width, 2 * image.height, {}};
  out.rgba.reserve(4 * out.Index(0, out.height));
  for (int y = 0; y < out.height; ++y) {
    const int near_y = y / 2, far_y = std::clamp(near_y + (y % 2) * 2 - 1, 0, image.height - 1);
    for (int x = 0; x < out.width; ++x) {
      const int near_x = x / 2, far_x = std::clamp(near_x + (x % 2) * 2 - 1, 0, image.width - 1);
      const std::uint8_t* near_row = image.rgba.data() + 4 * image.Index(0, near_y);
      const std::uint8_t* far_row = image.rgba.data() + 4 * image.Index(0, far_y);
      for (int c = 0; c < 4; ++c) {
        const int near = 3 * near_row[4 * near_x + c] + near_row[4 * far_x + c];
        const int far = 3 * far_row[4 * near_x + c] + far_row[4 * far_x + c];
        out.rgba.push_back(static_cast<std::uint8_t>((3 * near + far + 8) / 16));
      }
    }
  }
  return out;
}

}  // namespace

void FillTexture(const GlFunctions& gl, GLuint texture, const Image& picture, GLint filter) {
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.ActiveTexture(GlUnit(TextureUnit::kUpload));
  gl.BindTexture(GL_TEXTURE_2D, texture);
  for (const int axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    gl.TexParameteri(GL_TEXTURE_2D, static_cast<GLenum>(axis), GL_REPEAT);
  }
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.width, picture.height, 0, GL_RGBA,
                GL_UNSIGNED_BYTE, picture.rgba.data());
}

HeadTextures::HeadTextures(const GlFunctions& gl, const HeadSurface& surface) : gl_(gl) {
  gl_.GenTextures(kTextures, textures_);
  if (surface.pbr_materials.empty()) return;
  const auto fill = [this](Texture texture, const Image* map, const Image& neutral) {
    FillTexture(gl_, textures_[texture], map ? *map : neutral, GL_LINEAR);
  };
  fill(kNormal, surface.textures.normal_roughness_metal.get(), {1, 1, {128, 128, 255, 255}});
  fill(kEmissive, surface.textures.emission_openness.get(), {1, 1, {255, 255, 255, 255}});
}

HeadTextures::~HeadTextures() { gl_.DeleteTextures(kTextures, textures_); }

// Pictures are scaled until a texel is about as large as a sample, and the nearest texel is used:
// with four samples to a pixel that is smooth, while in software a filtered fetch costs as much as
// the rest of a pixel. Close to a face, where texels would be visible, they are filtered.
void HeadTextures::Load(HeadDescription& head, float samples_per_mm) {
  samples_per_mm = std::max(samples_per_mm, 1e-3f);
  if (const SkinTexture* texture = head.skin.Texture()) LoadSkin(*texture, samples_per_mm);
  if (head.base_colour()) LoadBaseColour(head, samples_per_mm);
}

void HeadTextures::LoadSkin(const SkinTexture& skin, float samples_per_mm) {
  const float texels_per_sample = SkinTexture::kTexelsPerMm / samples_per_mm;
  const Sampling sampling{
      std::clamp(static_cast<int>(std::lround(std::log2(texels_per_sample))), 0, 5),
      texels_per_sample < 0.5f ? GL_LINEAR : GL_NEAREST};
  if (skin_ == sampling) return;
  skin_ = sampling;
  for (const auto& [texture, picture] :
       {std::pair(kTint, &skin.tint), std::pair(kSkinRelief, &skin.relief)}) {
    Image scaled;
    for (int k = 0; k < sampling.level; ++k) scaled = Halved(k == 0 ? *picture : scaled);
    FillTexture(gl_, textures_[texture], sampling.level > 0 ? scaled : *picture, sampling.filter);
  }
}

HeadTextures::Sampling HeadTextures::SamplingOf(const Image& base_colour, float texels_per_sample) {
  // A photo has sharp edges, which look cut out with fewer texels per sample.
  constexpr float kFewest = 0.9f;
  constexpr int kMaxDoubled = 1 << 21;  // texels
  const int level =
      static_cast<int>(std::floor(std::log2(std::max(texels_per_sample, 0.01f) / kFewest)));
  if (level >= 0) return {level, GL_NEAREST};
  // Doubling a photo costs memory; filtering it nearly doubles the time for a pixel.
  if (level == -1 && 4 * base_colour.width * base_colour.height <= kMaxDoubled)
    return {level, GL_NEAREST};
  return {0, GL_LINEAR};
}

void HeadTextures::LoadBaseColour(const HeadDescription& head, float samples_per_mm) {
  const Image& base_colour = *head.base_colour();
  const Sampling sampling = SamplingOf(base_colour, head.photo_texels_per_mm / samples_per_mm);
  if (base_colour_ == sampling) return;
  base_colour_ = sampling;
  const auto halved = [&sampling](int side) { return std::max(side >> sampling.level, 1); };
  const Image scaled = sampling.level == 0  ? Image{}
                       : sampling.level < 0 ? Doubled(base_colour)
                                            : Shrunk(base_colour, halved(base_colour.width),
                                                     halved(base_colour.height));
  FillTexture(gl_, textures_[kBaseColour], sampling.level == 0 ? base_colour : scaled,
              sampling.filter);
}

}  // namespace fsm
