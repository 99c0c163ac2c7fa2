#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "face_fit/find/network/face_networks.h"
#include "face_fit/find/network/network_crop.h"
#include "face_fit/find/network/network_points.h"

namespace facefit {

/// A face with its points: x and y in pixels of the picture, y down, z in the same unit towards
/// the viewer, 0 about the middle of the head.
struct FoundFace {
  std::vector<glm::vec3> points;  ///< kNetworkPoints
  float certainty = 0;            ///< 0..1 that the points lie on a face
  float score = 1;                ///< 0..1 the detector's, which sees no face upside down
  NetworkCrop crop;               ///< around the points
  glm::vec2 PixelOf(PointIndex i) const { return glm::vec2(points[i]); }
  std::vector<glm::vec2> Line(std::span<const PointIndex> of) const {
    std::vector<glm::vec2> line;
    for (const PointIndex i : of) line.push_back(PixelOf(i));
    return line;
  }
};

/// Below that certainty there is no face: of pictures of all kinds a few reach 0.66, people and
/// drawn heads hardly less than 0.9.
inline constexpr float kCertainFace = 0.75F;

/// All faces, largest first. Looks at the whole picture, and at its parts unless a large face was
/// seen. Drops uncertain faces when several are found and at least one is certain.
std::vector<FoundFace> FindFaces(FaceNetworks& networks, const fsm::Image& image);

/// What a landmark network says of the crop it was shown (x, y, z of each point, in pixels of
/// kPointsPixels), as FoundFace has it.
std::vector<glm::vec3> PointsInPicture(std::span<const float> raw, const NetworkCrop& crop);

/// The square around a face's points, upright as its eyes are, as the landmark network is shown it.
/// `axes_rad`: of the box the points are measured with.
NetworkCrop CropAround(std::span<const glm::vec3> points, float axes_rad);
NetworkCrop CropAround(std::span<const glm::vec3> points);  ///< measured along the eyes

}  // namespace facefit
