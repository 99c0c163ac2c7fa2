#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "fsm/rig/pose.h"
#include "fsm/rig/tooth_arch.h"

namespace fsm {

/// The way of the tongue out of the mouth, in one state: between the edges of the teeth, then
/// between the lips. It is soft and takes the form of what it goes through; where there is no room
/// it stays behind the teeth. In the frame before the head's turn. Lifetime: one state;
/// what it is made from outlives it.
class TonguePath {
 public:
  /// `seam` pairs upper and lower vertices of the lips, from -x to +x, in `skin` as deformed.
  /// Arches as they are at rest.
  TonguePath(const Pose& pose, const ToothArch& upper, const ToothArch& lower,
             std::span<const std::pair<std::uint32_t, std::uint32_t>> seam,
             std::span<const glm::vec3> skin);

  /// How much of a tongue put out comes out at all, 0..1, by how far the mouth is open.
  float Share() const { return share_; }
  /// A place of the tongue, moved to where it has room.
  glm::vec3 Fit(glm::vec3 p) const;

 private:
  struct Gap {
    glm::vec3 high, low;
  };
  Gap LipsAt(float x) const;

  const Pose& pose_;
  const ToothArch& upper_;
  const ToothArch& lower_;
  std::vector<Gap> lips_;
  float teeth_low_ = 0, teeth_high_ = 0, front_z_ = 0;
  float open_from_ = 0, open_to_ = 0;  // the open part of the lips, by x
  float share_ = 0;
};

}  // namespace fsm
