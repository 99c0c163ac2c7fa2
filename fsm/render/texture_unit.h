#pragma once

#include <GL/glcorearb.h>

namespace fsm {

/// The unit that each texture of the shaders is bound to: GL_TEXTURE0 + unit.
enum class TextureUnit : GLint {
  kPass,  ///< read by passes that draw no head: background, samples
  kNoise,
  kStrands,
  kBaseColour,
  kTint,    ///< of painted skin, or plain
  kRelief,  ///< of skin, or the weave of cloth
  kNormalMap,
  kEmissiveMap,
  kUpload  ///< for uploads only, so that the frame's textures stay bound
};

constexpr GLenum GlUnit(TextureUnit unit) { return GL_TEXTURE0 + static_cast<GLenum>(unit); }

}  // namespace fsm
