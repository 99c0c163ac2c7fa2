#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/find/network/crop.h"
#include "face_fit/find/network/face_networks.h"
#include "face_fit/find/network/network_points.h"

namespace facefit {

/// A face the detector sees.
struct FaceBox {
  glm::vec2 centre;
  glm::vec2 size;
  float score = 0;
  std::array<glm::vec2, 2> eyes;  ///< the person's right and left
};

inline constexpr int kPointsPixels = 192;  ///< the side of what the landmark network is shown

/// A face with its points: x and y in pixels of the picture, y down, z in the same unit towards
/// the viewer, 0 about the middle of the head.
struct FoundFace {
  std::vector<glm::vec3> points;  ///< kNetworkPoints
  float certainty = 0;            ///< 0..1 that there is a face
  Crop crop;                      ///< what the network saw last
  glm::vec2 At(PointIndex i) const { return glm::vec2(points[i]); }
};

/// Below that certainty there is no face: of pictures of all kinds a few reach 0.66, people and
/// drawn heads hardly less than 0.9.
inline constexpr float kCertainFace = 0.75F;

/// All faces, largest first. Looks at the whole picture, and if nothing is found at its parts.
std::vector<FaceBox> FindFaces(FaceNetworks& networks, const fsm::Image& image);

/// The points of one face.
FoundFace FindPoints(FaceNetworks& networks, const fsm::Image& image, const FaceBox& box);

}  // namespace facefit
