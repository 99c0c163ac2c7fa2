#pragma once

#include <GL/glcorearb.h>

namespace fsm {

/// The unit that each texture of the shaders is bound to: GL_TEXTURE0 + unit.
enum class TextureUnit : GLint {
  kPass,  ///< what a pass that draws no head reads: background, samples
  kNoise,
  kStrands,
  kPhoto,
  kTint,    ///< of painted skin, or plain
  kRelief,  ///< of skin, or the weave of cloth
  kNormalMap,
  kEmissiveMap,
  kUpload  ///< which no shader reads: those of the frame stay bound
};

constexpr GLenum NameOf(TextureUnit unit) { return GL_TEXTURE0 + static_cast<GLenum>(unit); }

}  // namespace fsm
