#pragma once

#include <string>

#include "face_fit/find/head/observed_head.h"

namespace facefit {

/// What hides part of a face: a hand, a mask, dark glasses, hair across an eye, a microphone.
struct Occlusion {
  float measure = 0;  ///< from 1 on something does; relative to the limit set on uncovered faces
  std::string where;  ///< the part that resembles a face least, "the left cheek"
};

/// Detects whether something hides part of a face. The landmark network reports how certain it is
/// of a face. Each part of the face in turn is replaced by that part of the built-in head in the
/// photo's skin colour; if this makes the network much more certain, the photo shows something else
/// there. Beards, creases, glasses, hair on the forehead and shade hardly change its certainty.
Occlusion DetectOcclusion(FaceNetworks& networks, const ObservedHead& base, const FoundFace& face,
                          const fsm::Image& photo);

}  // namespace facefit
