#pragma once

#include "fsm/render/lighting.h"

namespace fsm {

/// Eyeballs, whose white, iris and pupil are found per pixel (shaders/eye_fragment.glsl). Destroy
/// while its context is current.
class EyeMaterial {
 public:
  EyeMaterial(const GlFunctions& gl, const Appearance& appearance);
  const GlProgram& program() const { return program_; }
  /// Hands over how the eyes stand and look. Nothing for a head without eyes.
  void Begin(const MaterialFrame& frame) const;

 private:
  void SetEyeballs(const View& view, const Sided<EyePose>& eyes, const EyeGeometry& geometry) const;
  void SetPictures(const MaterialFrame& frame, const Sided<EyePose>& eyes) const;

  GlProgram program_;
};

}  // namespace fsm
