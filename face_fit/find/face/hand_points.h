#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/face_finder.h"
#include "fsm/mesh/original/pnt_file.h"

namespace facefit {

/// Points set by hand: by number of the landmark network, in pixels of the upright photo scaled to
/// at most kWorkingSize.
using HandPoints = std::map<PointIndex, glm::vec2>;

/// A table of lines `NAME X Y`, NAME one of HandPointNames() or a number of MediaPipe's face mesh;
/// `#` begins a comment. Needed are both outer eye corners, nose_tip, both mouth corners and chin.
/// Errors: kBadValue "NAME:LINE: what was expected", also for a point that is set twice; without
/// the line for a point that is missing, and for corners of the eyes or of the mouth in one place.
vm::Result<HandPoints> ParseHandPoints(const std::string& name, std::string_view text);
/// Error: kBadValue, no point lies in a photo of that size.
vm::Result<void> CheckWithin(const HandPoints& points, int width, int height);
/// A point people can name; `needed`: a file of points must have it.
struct HandPointName {
  std::string_view name;
  PointIndex point;
  bool needed;
};
std::span<const HandPointName> HandPointList();
/// The names, with blanks between them.
std::string HandPointNames();

/// The points that a wireframe of the original, fitted to a photo of that size, gives. Error:
/// kBadValue if the wireframe is not one of the original's standard head, or its points lie in one
/// place.
vm::Result<HandPoints> PointsOfWireframe(const std::string& name, const fsm::PntFile& wireframe,
                                         int width, int height);

/// Completes a face of which some points are known: the others lie relative to them as on the
/// built-in head. REQUIRES: at least the points that ParseHandPoints needs.
FoundFace FaceFromHand(const ObservedHead& base, const HandPoints& points);

}  // namespace facefit
