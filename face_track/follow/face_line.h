#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "face_track/model/lips.h"
#include "fsm/rig/face_state.h"

namespace facetrack {

/// What one picture shows. Right and left are the person's; turns are the viewer's, as everywhere:
/// down, to the viewer's right, tilted to it.
struct FaceLine {
  double ms = 0;
  int person = 0;                        ///< 1 for the first, 2 for the next; 0 = no face
  float certainty = 0;                   ///< 0..1 that there is a face
  float miss = 0;                        ///< mm by which the points lie elsewhere, their median
  fsm::Angles head{};                    ///< degrees
  glm::vec3 place{0};                    ///< mm before the camera: right, up, towards it
  std::array<float, 2> lid{1, 1};        ///< right, left: 0 = shut, 1 = as at rest
  std::array<fsm::EyeAngles, 2> gaze{};  ///< right, left: degrees down and right, in the head
  float jaw = 0;                         ///< degrees
  Lips lips{};                           ///< beside their rest
  std::vector<float> units;              ///< doses of the table's channels
  Points points;                         ///< on the face, in the head's frame, mm
  std::vector<glm::vec2> places;         ///< where they are seen, pixels
};

}  // namespace facetrack
