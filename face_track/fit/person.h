#pragma once

#include <vector>

#include "face_track/fit/frame_fit.h"

namespace facetrack {

/// A person's own face at rest.
struct Person {
  Points rest;
  float miss = 0;  ///< mm by which the points lay elsewhere when it was found
};

/// What the network saw in one picture.
struct Sighting {
  std::vector<glm::vec2> places;  ///< kPoints, pixels
  std::vector<float> depth;       ///< of the network's points, mm, as it gives it
};

/// Where each point lies in the middle of these pictures, each axis by itself. REQUIRES: one or
/// more.
Points MedianOf(const std::vector<Points>& pictures);

/// The usual face bent to how these pictures show it: the median of where each point lies, and part
/// of the depth the network gives. What the face does in most of them is taken for its rest.
/// REQUIRES: one picture or more.
Person Meet(const FrameFit& fit, const std::vector<Sighting>& pictures);

}  // namespace facetrack
