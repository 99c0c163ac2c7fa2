#pragma once

#include <string>

#include "face_fit/find/head/observed_head.h"

namespace facefit {

/// What hides part of a face: a hand, a mask, dark glasses, hair across an eye, a microphone.
struct Occlusion {
  float measure = 0;  ///< 1 and more: something does
  std::string where;  ///< the part that looks least like a face, "the left cheek"
};

/// Looks for something before a face. The landmark network says how sure it is that it sees a face.
/// Each part of the face in turn is replaced by the same part of the built-in head, in the photo's
/// skin colour; if the network is much surer then, the photo shows something else there. Beards,
/// creases, glasses, hair on the forehead and shade hardly change how sure it is.
Occlusion DetectOcclusion(FaceNetworks& networks, const ObservedHead& base, const FoundFace& face,
                          const fsm::Image& photo);

}  // namespace facefit
