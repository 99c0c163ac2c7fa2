#include "face_fit/find/upright.h"

#include <cmath>

namespace facefit {
namespace {

/// How clearly and how upright the largest face is seen, 0..1. Upside down counts nothing.
float Clearness(FaceNetworks& networks, const fsm::Image& photo) {
  const auto boxes = FindFaces(networks, photo);
  if (boxes.empty()) return 0;
  const FoundFace face = FindPoints(networks, photo, boxes.front());
  const glm::vec2 eyes = glm::vec2(face.points[263]) - glm::vec2(face.points[33]);
  const float tilt = std::atan2(eyes.y, eyes.x);
  return face.certainty * std::max(std::cos(tilt), 0.0F);
}

}  // namespace

int UprightWay(FaceNetworks& networks, const fsm::Image& photo) {
  constexpr float kClear = 0.93F;
  float best = Clearness(networks, photo);
  int way = 1;
  if (best > kClear) return way;
  for (const int other : {6, 8, 3}) {
    // A photo that lies is rare, so another way must be clearly better.
    const float clear = Clearness(networks, Turned(photo, other));
    if (clear > best + 0.04F) {
      best = clear;
      way = other;
    }
  }
  return way;
}

}  // namespace facefit
