#pragma once

#include <string>

#include "face_fit/fit/base_head.h"

namespace facefit {

/// What hides part of a face: a hand, a mask, dark glasses, hair across an eye, a microphone.
struct Cover {
  float measure = 0;  ///< 1 and more: something does
  std::string where;  ///< the part that looks least like a face, "the left cheek"
};

/// The landmark network says how sure it is of having a face before it. Each part of the face in
/// turn is replaced by that of the built-in head, in the photo's skin colour: if the network is
/// much surer then, something else than a face was to be seen there. Beards, wrinkles, glasses,
/// hair on the forehead and shade hardly trouble it.
Cover FindCover(FaceNetworks& networks, const BaseHead& base, const FoundFace& face,
                const fsm::Image& photo);

}  // namespace facefit
