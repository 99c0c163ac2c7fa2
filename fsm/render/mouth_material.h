#pragma once

#include <optional>

#include "fsm/render/lighting.h"

namespace fsm {

/// Teeth, gums, tongue and lining of the mouth, lit by the light that enters between the lips
/// (shaders/mouth_vertex.glsl). Destroy while its context is current.
class MouthMaterial {
 public:
  /// `appearance` must outlive it.
  MouthMaterial(const GlFunctions& gl, const Appearance& appearance);
  const GlProgram& program() const { return program_; }
  /// Measures the mouth in a frame and sets the uniforms for it.
  void Begin(const MaterialFrame& frame);
  /// Tells whether the mouth of the frame could be measured.
  bool has_opening() const { return opening_.has_value(); }
  /// Tells whether the lips touch all along; then only the lining may be visible, in the nostrils.
  bool lips_shut() const { return opening_ && opening_->IsShut(); }
  /// Returns the gap between the lips at the midline in millimetres; 0 if it is not known.
  float gap_mm() const;
  /// Returns how far the lower teeth have dropped from rest, in millimetres; 0 if not known.
  float jaw_drop_mm() const;

 private:
  const Appearance& appearance_;
  GlProgram program_;
  std::optional<MouthFinder::Opening> opening_;  // that of the last frame
};

}  // namespace fsm
