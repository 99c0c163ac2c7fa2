#pragma once

#include <optional>

#include "fsm/render/gl_functions.h"
#include "fsm/render/head_description.h"

namespace fsm {

/// The textures of one head, its skin and its pictures, as fine as the view can show them. Destroy
/// while its context is current.
class HeadTextures {
 public:
  HeadTextures(const GlFunctions& gl, const HeadSurface& surface);
  ~HeadTextures();
  HeadTextures(const HeadTextures&) = delete;
  HeadTextures& operator=(const HeadTextures&) = delete;

  /// Fills the textures of skin and base colour, where the head has them, at the samples'
  /// resolution. Blocks until the skin is painted; before this call it is drawn plain.
  void Load(HeadDescription& head, float samples_per_mm);

  /// GL names; 0 for a texture that the head does not have.
  GLuint tint() const { return skin_ ? textures_[kTint] : 0; }
  GLuint skin_relief() const { return skin_ ? textures_[kSkinRelief] : 0; }
  GLuint base_colour() const { return base_colour_ ? textures_[kBaseColour] : 0; }
  GLuint normal_roughness_metal() const { return textures_[kNormal]; }
  GLuint emission_openness() const { return textures_[kEmissive]; }

 private:
  enum Texture { kTint, kSkinRelief, kBaseColour, kNormal, kEmissive, kTextures };

  /// How a picture is loaded: halved `level` times (-1: doubled), with this GL filter.
  struct Sampling {
    int level;
    GLint filter;
    bool operator==(const Sampling&) const = default;
  };
  void LoadSkin(const SkinTexture& skin, float samples_per_mm);
  static Sampling SamplingOf(const Image& base_colour, float texels_per_sample);
  void LoadBaseColour(const HeadDescription& head, float samples_per_mm);

  const GlFunctions& gl_;
  GLuint textures_[kTextures] = {};
  std::optional<Sampling> skin_, base_colour_;  // as currently loaded
};

/// Fills a texture with a repeating picture, row 0 at v = 0. `filter`: GL_NEAREST or GL_LINEAR.
void FillTexture(const GlFunctions& gl, GLuint texture, const Image& picture, GLint filter);

}  // namespace fsm
