#include "face_fit/find/face/upright.h"

#include <cmath>

#include "face_fit/picture/filters.h"

namespace facefit {
namespace {

/// How many faces there are, and how many of them are seen clearly and upright: each counts 0..1,
/// upside down nothing. All are looked at: in a group the largest may lean far to one side.
/// `clear`: the same, weighed by how sure the detector is; the landmark network alone draws an
/// upright face onto one that stands on its head.
struct Seen {
  float faces = 0, upright = 0, clear = 0;
};

Seen Look(FaceNetworks& networks, const fsm::Image& photo) {
  Seen seen;
  for (const FoundFace& face : FindFaces(networks, photo)) {
    const glm::vec2 eyes = face.At(point::kEyeOuterLeft) - face.At(point::kEyeOuterRight);
    const float tilt = std::atan2(eyes.y, eyes.x);
    seen.faces += 1;
    const float upright = face.certainty * std::max(std::cos(tilt), 0.0F);
    seen.upright += upright;
    seen.clear += face.score * upright;
  }
  return seen;
}

}  // namespace

int UprightOrientation(FaceNetworks& networks, const fsm::Image& photo) {
  const Seen seen = Look(networks, photo);
  // Some of several people may lean, but not all to the same side.
  const float most = seen.faces > 1 ? 0.75F : 0.93F;
  float best = seen.clear;
  int orientation = 1;
  if (seen.faces > 0 && seen.upright > most * seen.faces) return orientation;
  for (const int other : {6, 8, 3}) {
    // A photo that lies is rare, so another orientation must be clearly better.
    const float clear = Look(networks, Turned(photo, other)).clear;
    if (clear > best + 0.04F * std::max(seen.faces, 1.0F)) {
      best = clear;
      orientation = other;
    }
  }
  return orientation;
}

}  // namespace facefit
