#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/found_face.h"
#include "fsm/mesh/original/pnt_file.h"

namespace facefit {

/// Points set by hand, by number of the landmark network: pixels of the upright photo scaled down
/// to at most kWorkingSize.
using HandPoints = std::map<PointIndex, glm::vec2>;

/// Parses lines `NAME X Y`, where NAME is one of PointNamesText() or a number of MediaPipe's face
/// mesh; `#` begins a comment. Required are both outer eye corners, nose_tip, both mouth corners
/// and chin. Errors: kBadValue "NAME:LINE: what was expected", also for a point that is set twice;
/// without a line number for a missing point, and for corners of the eyes or of the mouth that
/// coincide.
vm::Result<HandPoints> ParseHandPoints(const std::string& name, std::string_view text);
/// Checks that a point lies in a photo of that size. Error: kBadValue, none does.
vm::Result<void> CheckWithin(const HandPoints& points, int width, int height);
/// A point with a name; `needed`: ParseHandPoints requires it.
struct NamedPoint {
  std::string_view name;
  PointIndex point;
  bool needed;
};
std::span<const NamedPoint> NamedPoints();
/// Returns all names, separated by blanks.
std::string PointNamesText();

/// Returns the points of a wireframe of the original that was fitted to a photo of that size.
/// Error: kBadValue if the wireframe is not one of the original's standard head, or if its points
/// coincide.
vm::Result<HandPoints> PointsOfWireframe(const std::string& name, const fsm::PntFile& wireframe,
                                         int width, int height);

/// Completes a face from some of its points; the others are placed relative to them as on the
/// built-in head. REQUIRES: at least the points that ParseHandPoints requires.
FoundFace FaceFromHand(const ObservedHead& base, const HandPoints& points);

}  // namespace facefit
