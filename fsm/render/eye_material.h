#pragma once

#include "fsm/render/lighting.h"

namespace fsm {

/// Eyeballs whose sclera, iris and pupil are computed per pixel (shaders/eye_fragment.glsl).
/// Destroy while its context is current.
class EyeMaterial {
 public:
  EyeMaterial(const GlFunctions& gl, const Appearance& appearance);
  const GlProgram& program() const { return program_; }
  /// Sets the uniforms for position and gaze of the eyes. Does nothing for a head without eyes.
  void Begin(const MaterialFrame& frame) const;

 private:
  void SetEyeballs(const FrameCamera& view, const Sided<MeasuredEye>& eyes,
                   const Sided<EyeGeometry>& geometry) const;
  void SetPictures(const MaterialFrame& frame, const Sided<MeasuredEye>& eyes) const;

  GlProgram program_;
};

}  // namespace fsm
