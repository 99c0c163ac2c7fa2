#pragma once

#include <utility>

#include "face_fit/find/network/found_face.h"

namespace facefit {

/// A mouth from x = 50 to 150 whose lips meet at y = 100, by its points.
inline FoundFace StraightMouth() {
  FoundFace face;
  constexpr std::pair<std::size_t, std::size_t> kInner[] = {{191, 95},  {80, 88},   {81, 178},
                                                            {82, 87},   {13, 14},   {312, 317},
                                                            {311, 402}, {310, 318}, {415, 324}};
  float x = 60;
  for (const auto& [upper, lower] : kInner) {
    face.points[upper] = face.points[lower] = glm::vec3(x, 100, 0);
    x += 10;
  }
  face.points[61] = glm::vec3(50, 100, 0);
  face.points[291] = glm::vec3(150, 100, 0);
  return face;
}

}  // namespace facefit
