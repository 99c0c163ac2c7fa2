#pragma once

#include <array>
#include <optional>

#include "fsm/render/mouth_material.h"

namespace fsm {

/// What wears a photo, which brought its own light (shaders/photo_fragment.glsl): skin, lips, the
/// sheet beside them, lashes of shut lids. Its programs are made for the first head that needs
/// them. Destroy while its context is current.
class PhotoMaterial {
 public:
  /// `gl` and `appearance` outlive it.
  PhotoMaterial(const GlFunctions& gl, const Appearance& appearance)
      : gl_(gl), appearance_(appearance) {}
  /// Whether a part of a head is drawn by it.
  static bool Draws(Material material, const HeadBuffers& head);
  void Prepare(const HeadBuffers& head);
  /// Those that were made, by SkinDetail.
  const std::array<std::optional<GlProgram>, 3>& programs() const { return programs_; }
  /// REQUIRES: Prepare of the frame's head.
  void Begin(const MaterialFrame& frame, const MouthMaterial& mouth) const;
  void Use(const DrawnPart& part, const HeadBuffers& head, bool creased) const;

 private:
  const GlFunctions& gl_;
  const Appearance& appearance_;
  std::array<std::optional<GlProgram>, 3> programs_;
};

}  // namespace fsm
