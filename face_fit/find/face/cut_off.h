#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include "face_fit/find/network/face_finder.h"
#include "fsm/base/side.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// Returns the names that are marked true.
std::string JoinedNames(std::initializer_list<std::pair<bool, const char*>> parts,
                        const char* separator = ", ");

/// Which parts of a head lie beyond the edges of its photo. The network guesses their points, and
/// is as certain of these as of those it sees.
struct CutOff {
  bool forehead = false, chin = false;
  fsm::Sided<bool> ears;
};
CutOff CutOffParts(const FoundFace& face, const fsm::Image& photo);
/// Returns the names of the parts that are cut off, separated by commas; "" if there are none.
std::string NamesOf(const CutOff& cut);

/// Returns which corners of a face coincide, a clause, or nothing if none do: the outer corners of
/// the eyes must lie apart, because they give a face's size, and those of the mouth, because lips
/// are measured along them. `pixel_of`: the pixel of a point.
std::optional<std::string> CoincidingCorners(const std::function<glm::vec2(PointIndex)>& pixel_of);

/// Checks that the photo shows both eyes, the nose and the mouth, without which no face can be
/// made. Error: kBadValue, which of them the photo cuts off, or CoincidingCorners.
vm::Result<void> CheckFeaturesShown(const FoundFace& face, const fsm::Image& photo);

}  // namespace facefit
