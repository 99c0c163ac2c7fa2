#pragma once

#include <string>

#include "face_fit/find/network/face_finder.h"
#include "fsm/base/side.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// Which parts of a head lie beyond the edges of its photo: the network guesses their points all
/// the same, and is as certain of them as of those it sees.
struct CutOff {
  bool forehead = false, chin = false;
  fsm::Sided<bool> ears;
};
CutOff CutOffParts(const FoundFace& face, const fsm::Image& photo);
/// The parts in words, with commas between them; "" if nothing is cut off.
std::string NamesOf(const CutOff& cut);

/// A face cannot be made of less than both eyes, the nose and the mouth. Error: kBadValue, which of
/// them the photo cuts off.
vm::Result<void> CheckFeaturesShown(const FoundFace& face, const fsm::Image& photo);

}  // namespace facefit
