#pragma once

#include <optional>
#include <string>

#include "face_fit/find/head/observed_head.h"

namespace facefit {

class FaceNetworks;

/// Limits of Occlusion::covered: from kMaybeCovered on something may be there, from kSurelyCovered
/// on something is. kSurelyCovered was tested on 21 other faces: three exceeded it, two of these
/// had hair before them. Three faces lay between the two limits, and nothing hid any of them;
/// paint, hard light and a turned head had misled the detector.
inline constexpr float kMaybeCovered = 1, kSurelyCovered = 1.5F;

/// What hides part of a face: a hand, a mask, dark glasses, hair across an eye, a microphone.
struct Occlusion {
  /// Evidence of an occlusion divided by its limit, set on uncovered faces; below kMaybeCovered
  /// there is none.
  float covered = 0;
  /// The part of the face that resembles a face least, "the left cheek"; nothing where the network
  /// is less certain of the face than it should be, but no part explains that.
  std::optional<std::string> part_name;
};

/// Detects whether something hides part of a face. The landmark network reports how certain it is
/// of a face. Each part of the face in turn is replaced by that part of the built-in head in the
/// photo's skin colour; if this makes the network much more certain, the photo shows something else
/// there. Beards, creases, glasses, hair on the forehead and shade hardly change its certainty.
Occlusion DetectOcclusion(FaceNetworks& networks, const ObservedHead& base, const FoundFace& face,
                          const fsm::Image& photo);

}  // namespace facefit
