#pragma once

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

  /// Gives the head its skin, which is plain until then, if it has one. Waits until it is painted.
  void WearSkin(HeadBuffers& head, float samples_per_mm);

  /// GL names; 0 for what the head does not have.
  GLuint tint() const { return has_skin_ ? textures_[kTint] : 0; }
  GLuint skin_relief() const { return has_skin_ ? textures_[kSkinRelief] : 0; }
  GLuint photo() const { return has_photo_ ? textures_[kPhoto] : 0; }
  GLuint normal_map() const { return textures_[kNormal]; }
  GLuint emissive_map() const { return textures_[kEmissive]; }

 private:
  enum Texture { kTint, kSkinRelief, kPhoto, kNormal, kEmissive, kTextures };

  const GlFunctions& gl_;
  GLuint textures_[kTextures] = {};
  bool has_photo_;
  bool has_skin_ = false;
  int skin_level_ = 0;
  GLint skin_filter_ = 0;
};

/// Fills a texture with an RGBA picture that repeats, row 0 at v = 0. `filter`: GL_NEAREST or
/// GL_LINEAR.
void FillTexture(const GlFunctions& gl, GLuint texture, int width, int height,
                 const std::uint8_t* rgba, GLint filter);

}  // namespace fsm
