#pragma once

#include <array>
#include <string>
#include <string_view>

#include "face_track/model/seen_face.h"
#include "fsm/rig/face_state.h"

namespace facetrack {

/// What is measured of a mouth: how far its parts lie from where they are at rest, up or outward,
/// both sides together. Millimetres on a mouth that is 50 mm wide at rest, as mouth parameters.
enum Lip : std::size_t {
  kUpperInner,      ///< up, the middle of the upper lip's inner edge
  kUpperInnerSide,  ///< halfway to the corners
  kUpperOuter,
  kUpperOuterSide,
  kLowerInner,
  kLowerInnerSide,
  kLowerOuter,
  kLowerOuterSide,
  kCornerOut,
  kCornerUp,
  kInnerCornerOut,
  kChinUp,
  kApart  ///< gap / (gap + 2 mm): lips that part a little are seen to part less than they do
};
inline constexpr std::size_t kLips = kApart + 1;
using Lips = std::array<float, kLips>;
/// REQUIRES: kPoints points each.
Lips LipsOf(const Points& points, const Points& rest);

/// What a mouth does, in the terms of vdm's tracks: parameters at full articulation, which a face
/// at its usual MouthScale shows three quarters of. A person filmed is taken to speak as such a
/// face does. Film does not show the tongue.
struct TrackedMouth {
  std::array<float, fsm::kMouthParameters> parameters{};
  float seal = 1;
};

/// The mouth parameters that lips show: a table of factors that face_track_learn makes of pictures
/// of our heads, whose parameters are known (docs/tracking.md).
struct MouthOfLips {
  /// [parameter][lip]
  std::array<std::array<float, kLips>, fsm::kMouthParameters> factors{};
  float closed_mm = 0, open_mm = 1;  ///< gaps between which the seal goes from 1 to 0

  TrackedMouth Mouth(const Lips& lips) const;
  /// By how many mm parameters part the inner lips, less than 0 where they press them together.
  static float Gap(const std::array<float, fsm::kMouthParameters>& parameters);

  static vm::Result<MouthOfLips> Parse(const std::string& name, std::string_view text);
  std::string Print() const;
  /// The table the programs carry.
  static const MouthOfLips& Shipped();
};

}  // namespace facetrack
