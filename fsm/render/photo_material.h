#pragma once

#include <array>
#include <optional>
#include <span>

#include "fsm/render/draw_order.h"
#include "fsm/render/mouth_material.h"

namespace fsm {

/// Parts that wear a photo, which includes its own light (shaders/photo_fragment.glsl): skin, lips,
/// the sheet beside them, lashes of shut lids. Programs are compiled for the first head that needs
/// them. Destroy while its context is current.
class PhotoMaterial {
 public:
  /// `gl` and `appearance` must outlive it.
  PhotoMaterial(const GlFunctions& gl, const Appearance& appearance)
      : gl_(gl), appearance_(appearance) {}
  /// Tells whether it draws this material of a head.
  static bool Draws(Material material, const HeadDescription& head);
  void Prepare(const HeadDescription& head, std::span<const DrawnPart> parts);
  /// The programs compiled so far, by SkinDetail.
  const std::array<std::optional<GlProgram>, 3>& programs() const { return programs_; }
  /// REQUIRES: Prepare was called for the frame's head.
  void Begin(const MaterialFrame& frame, const MouthMaterial& mouth) const;
  void Use(const DrawnPart& drawn, const HeadDescription& head, bool creased) const;

 private:
  const GlFunctions& gl_;
  const Appearance& appearance_;
  std::array<std::optional<GlProgram>, 3> programs_;
};

}  // namespace fsm
