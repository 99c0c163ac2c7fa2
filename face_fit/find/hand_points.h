#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "face_fit/find/face_finder.h"
#include "face_fit/fit/base_head.h"
#include "fsm/mesh/pnt_file.h"

namespace facefit {

/// Points set by hand: of the landmark network, by number, in pixels of the photo as it is worked
/// on (upright, at most kWorkingSide on a side).
using HandPoints = std::map<std::size_t, glm::vec2>;

/// A table of lines `NAME X Y`, NAME one of HandPointNames() or a number of MediaPipe's face mesh;
/// `#` begins a comment. Needed are both outer eye corners, nose_tip, both mouth corners and chin.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<HandPoints> ParseHandPoints(const std::string& name, std::string_view text);
/// A point people can name; `needed`: a file of points must have it.
struct HandPointName {
  std::string_view name;
  std::size_t point;
  bool needed;
};
std::span<const HandPointName> HandPointList();
/// The names, with blanks between them.
std::string HandPointNames();

/// The points that a wireframe of the original fitted to a photo of that size gives. Error:
/// kBadValue if it is none of its standard head.
vm::Result<HandPoints> PointsOfWireframe(const std::string& name, const fsm::PntFile& wireframe,
                                         int width, int height);

/// All points of a face of which some are known: the others lie to them as on the built-in head.
FoundFace FaceFromHand(const BaseHead& base, const HandPoints& points);

}  // namespace facefit
