#pragma once

#include <string>

#include "face_fit/find/network/found_face.h"
#include "fsm/base/side.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// Which parts of a head lie beyond the edges of its photo. The network guesses their points, and
/// is as certain of these as of those it sees.
struct CutOffParts {
  bool forehead = false, chin = false;
  fsm::Sided<bool> ears;
};
/// Returns the parts whose points lie outside the photo.
CutOffParts FindCutOffParts(const FoundFace& face, const fsm::Image& photo);
/// Returns the names of the parts that are cut off, separated by commas; "" if there are none.
std::string NamesOf(const CutOffParts& cut);

/// Checks that the photo shows both eyes, the nose and the mouth, without which no face can be
/// made. Error: kBadValue, which of them the photo cuts off, or CoincidingCorners
/// (coinciding_corners.h).
vm::Result<void> CheckFeaturesShown(const FoundFace& face, const fsm::Image& photo);

}  // namespace facefit
