#pragma once

#include <cstdint>
#include <optional>

#include "fsm/render/gl_functions.h"
#include "fsm/render/head_buffers.h"

namespace fsm {

/// The textures of one head: its skin in the detail that the picture can show, and what it wears of
/// pictures. Destroy while its context is current.
class HeadTextures {
 public:
  HeadTextures(const GlFunctions& gl, const HeadBuffers& head);
  ~HeadTextures();
  HeadTextures(const HeadTextures&) = delete;
  HeadTextures& operator=(const HeadTextures&) = delete;

  /// Gives the head its skin, which is plain until then, if it has one, and its photo, both as fine
  /// as samples are. Waits until the skin is painted.
  void Wear(HeadBuffers& head, float samples_per_mm);

  /// GL names; 0 for what the head does not have.
  GLuint tint() const { return skin_ ? textures_[kTint] : 0; }
  GLuint skin_relief() const { return skin_ ? textures_[kSkinRelief] : 0; }
  GLuint photo() const { return photo_ ? textures_[kPhoto] : 0; }
  GLuint normal_map() const { return textures_[kNormal]; }
  GLuint emissive_map() const { return textures_[kEmissive]; }

 private:
  enum Texture { kTint, kSkinRelief, kPhoto, kNormal, kEmissive, kTextures };

  /// How a picture is worn: halved so often (-1: doubled), and filtered or not.
  struct Fit {
    int level;
    GLint filter;
    bool operator==(const Fit&) const = default;
  };
  void WearSkin(HeadBuffers& head, float samples_per_mm);
  static Fit FitOf(const Image& photo, float texels_per_sample);
  void WearPhoto(const HeadBuffers& head, float samples_per_mm);

  const GlFunctions& gl_;
  GLuint textures_[kTextures] = {};
  std::optional<Fit> skin_, photo_;  // as they are worn
};

/// Fills a texture with an RGBA picture that repeats, row 0 at v = 0. `filter`: GL_NEAREST or
/// GL_LINEAR.
void FillTexture(const GlFunctions& gl, GLuint texture, int width, int height,
                 const std::uint8_t* rgba, GLint filter);

}  // namespace fsm
