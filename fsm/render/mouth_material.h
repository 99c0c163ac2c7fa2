#pragma once

#include <optional>

#include "fsm/render/lighting.h"

namespace fsm {

/// Teeth, gums, tongue and the lining of the mouth, by the light that comes in between the lips
/// (shaders/mouth_vertex.glsl). Destroy while its context is current.
class MouthMaterial {
 public:
  /// `appearance` outlives it.
  MouthMaterial(const GlFunctions& gl, const Appearance& appearance);
  const GlProgram& program() const { return program_; }
  /// Measures the mouth of a frame, and hands it over.
  void Begin(const MaterialFrame& frame);
  /// Whether it is known how light comes into the mouth of the frame.
  bool has_opening() const { return opening_.has_value(); }
  /// Whether the lips meet all along, so that only the lining may be seen: nostrils have it, too.
  bool lips_shut() const { return opening_ && opening_->IsShut(); }
  /// How far the lips are apart in the middle, millimetres; 0 where it is not known.
  float gap_mm() const;
  /// How far the lower teeth are below where they stand at rest, millimetres; 0 likewise.
  float jaw_drop_mm() const;

 private:
  const Appearance& appearance_;
  GlProgram program_;
  std::optional<MouthFinder::Opening> opening_;  // of the last frame
};

}  // namespace fsm
