#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "face_fit/find/network/network_crop.h"
#include "face_track/model/seen_face.h"

namespace facetrack {

/// A camera at the origin that looks along -z; y is up, in pictures it runs down.
struct Lens {
  float focal = 1;   ///< pixels
  glm::vec2 middle;  ///< pixel on the axis

  static Lens Of(int width, int height, float field_degrees);  ///< seen from below to above
  glm::vec2 Project(glm::vec3 q) const { return middle + focal / -q.z * glm::vec2(q.x, -q.y); }
  glm::vec3 Unproject(glm::vec2 pixel, float z) const {
    const glm::vec2 d = (pixel - middle) * (-z / focal);
    return {d.x, -d.y, z};
  }
};

/// Where a head is before the camera: millimetres, if the outer corners of its eyes are 90 apart.
struct Pose {
  glm::mat3 turn{1};
  glm::vec3 place{0, 0, -700};  ///< of the head's origin, midway between the ears
  glm::vec3 operator()(glm::vec3 p) const { return turn * p + place; }
  glm::vec3 Inverse(glm::vec3 q) const { return glm::transpose(turn) * (q - place); }
};

/// What of a turn slides points: degrees down and right as seen from the lens.
glm::vec2 SeenTurn(const Pose& pose);
/// Where a point is seen that lies at `p` in the head's frame, slide included.
glm::vec2 SeenAt(const SeenFace& face, const Lens& lens, const Pose& pose, std::size_t point,
                 glm::vec3 p);
/// The square in which the network is shown a head: a fixed part of it, upright, so that what the
/// face does changes nothing.
facefit::NetworkCrop CropOf(const Lens& lens, const Pose& pose);

/// The points as kPoints places in the picture.
std::vector<glm::vec2> PlacesOf(const facefit::AttentiveFace& face);

}  // namespace facetrack
