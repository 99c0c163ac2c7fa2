#include "fsm/render/head_textures.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fsm/image/shrink.h"

namespace fsm {
namespace {

/// A square RGBA picture at half its size.
std::vector<std::uint8_t> Halve(const std::uint8_t* rgba, int side) {
  const auto row = static_cast<std::size_t>(side) * 4;
  std::vector<std::uint8_t> half;
  half.reserve(row * static_cast<std::size_t>(side) / 4);
  for (std::size_t y = 0; y + 1 < static_cast<std::size_t>(side); y += 2) {
    const std::uint8_t* a = rgba + y * row;
    for (std::size_t x = 0; x + 7 < row; x += 8) {
      for (std::size_t c = x; c < x + 4; ++c) {
        half.push_back(
            static_cast<std::uint8_t>((a[c] + a[c + 4] + a[c + row] + a[c + row + 4] + 2U) / 4U));
      }
    }
  }
  return half;
}

/// An RGBA picture at twice its size, as a linear filter would show it.
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

void FillTexture(const GlFunctions& gl, GLuint texture, int width, int height,
                 const std::uint8_t* rgba, GLint filter) {
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.ActiveTexture(GL_TEXTURE6);  // which no shader reads: those of the frame stay bound
  gl.BindTexture(GL_TEXTURE_2D, texture);
  for (const int axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    gl.TexParameteri(GL_TEXTURE_2D, static_cast<GLenum>(axis), GL_REPEAT);
  }
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

HeadTextures::HeadTextures(const GlFunctions& gl, const HeadBuffers& head) : gl_(gl) {
  gl_.GenTextures(kTextures, textures_);
  if (head.pbr_materials().empty()) return;
  const auto wear = [this](Texture texture, const Image& picture) {
    FillTexture(gl_, textures_[texture], picture.width, picture.height, picture.rgba.data(),
                GL_LINEAR);
  };
  wear(kNormal, head.normal_map() ? *head.normal_map() : Image{1, 1, {128, 128, 255, 255}});
  wear(kEmissive, head.emissive_map() ? *head.emissive_map() : Image{1, 1, {255, 255, 255, 255}});
}

HeadTextures::~HeadTextures() { gl_.DeleteTextures(kTextures, textures_); }

// Pictures are worn with a texel about as large as a sample, of which the nearest is taken: with
// four samples to a pixel that is smooth, and in software a filtered fetch costs as much as
// everything else of a pixel. Of a face so near that texels show they are filtered.
void HeadTextures::Wear(HeadBuffers& head, float samples_per_mm) {
  WearSkin(head, std::max(samples_per_mm, 1e-3F));
  if (head.photo()) WearPhoto(head, std::max(samples_per_mm, 1e-3F));
}

void HeadTextures::WearSkin(HeadBuffers& head, float samples_per_mm) {
  const SkinTexture* skin = head.skin();
  if (!skin) return;
  const float texels_per_sample = SkinTexture::kTexelsPerMm / samples_per_mm;
  const Fit fit{std::clamp(static_cast<int>(std::lround(std::log2(texels_per_sample))), 0, 5),
                texels_per_sample < 0.5F ? GL_LINEAR : GL_NEAREST};
  if (skin_ == fit) return;
  skin_ = fit;
  for (const auto& [texture, picture] :
       {std::pair(kTint, &skin->tint), std::pair(kSkinRelief, &skin->relief)}) {
    int side = SkinTexture::kSide;
    std::vector<std::uint8_t> halved;
    const std::uint8_t* rgba = picture->data();
    for (int k = 0; k < fit.level; ++k) {
      halved = Halve(rgba, side);
      side /= 2;
      rgba = halved.data();
    }
    FillTexture(gl_, textures_[texture], side, side, rgba, fit.filter);
  }
}

HeadTextures::Fit HeadTextures::FitOf(const Image& photo, float texels_per_sample) {
  // A photo has edges: with fewer texels to a sample those are seen to be cut out.
  constexpr float kFewest = 0.9F;
  constexpr int kMostDoubled = 1 << 21;  // texels
  const int level =
      static_cast<int>(std::floor(std::log2(std::max(texels_per_sample, 0.01F) / kFewest)));
  if (level >= 0) return {level, GL_NEAREST};
  // To double it costs memory, to filter it nearly as much time as everything else of a pixel.
  if (level == -1 && 4 * photo.width * photo.height <= kMostDoubled) return {level, GL_NEAREST};
  return {0, GL_LINEAR};
}

void HeadTextures::WearPhoto(const HeadBuffers& head, float samples_per_mm) {
  const Image& photo = *head.photo();
  const Fit fit = FitOf(photo, head.photo_texels_per_mm() / samples_per_mm);
  if (photo_ == fit) return;
  photo_ = fit;
  const auto halved = [&fit](int side) { return std::max(side >> fit.level, 1); };
  const Image scaled = fit.level == 0  ? Image{}
                       : fit.level < 0 ? Doubled(photo)
                                       : Shrunk(photo, halved(photo.width), halved(photo.height));
  const Image& worn = fit.level == 0 ? photo : scaled;
  FillTexture(gl_, textures_[kPhoto], worn.width, worn.height, worn.rgba.data(), fit.filter);
}

}  // namespace fsm
