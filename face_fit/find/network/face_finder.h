#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "face_fit/find/network/face_networks.h"
#include "face_fit/find/network/network_crop.h"
#include "face_fit/find/network/network_points.h"

namespace facefit {

/// A face with its points: x and y in pixels of the image, y down; z in the same unit towards the
/// viewer, 0 near the middle of the head.
struct FoundFace {
  PerPoint<glm::vec3> points = {};
  float certainty = 0;  ///< confidence, 0..1, that the points lie on a face
  float score = 1;      ///< of the detector, 0..1; it finds no face that is upside down
  NetworkCrop crop;     ///< around the points
  glm::vec2 PixelOf(PointIndex i) const { return glm::vec2(points[i]); }
  /// Returns the way from the right eye's outer corner to the left one's, pixels.
  glm::vec2 AcrossEyes() const {
    return PixelOf(point::kEyeOuterLeft) - PixelOf(point::kEyeOuterRight);
  }
  std::vector<glm::vec2> Line(std::span<const PointIndex> of) const {
    std::vector<glm::vec2> line;
    for (const PointIndex i : of) line.push_back(PixelOf(i));
    return line;
  }
};

/// Returns whether the lips are parted, so that teeth or the dark of the mouth show between them.
bool LipsApart(const FoundFace& face);

/// Certainty below which there is no face: a few images of other things reach 0.66; people and
/// drawn heads hardly fall below 0.9.
inline constexpr float kCertainFace = 0.75F;

/// Returns all faces, largest first. Searches the whole image, and its parts unless it shows a
/// large face. Drops uncertain faces if at least one of several is certain.
std::vector<FoundFace> FindFaces(FaceNetworks& networks, const fsm::Image& image);

/// Converts the output of a landmark network (x, y, z of each point, in pixels of
/// kLandmarkInputPixels) to points of FoundFace. `crop`: what the network was shown.
PerPoint<glm::vec3> PointsInImage(std::span<const float> raw, const NetworkCrop& crop);

/// Returns the square around a face's points to show to the landmark network, turned as the line of
/// its eyes. `axes_rad`: angle of the box that measures the points.
NetworkCrop CropAround(std::span<const glm::vec3> points, float axes_rad);
NetworkCrop CropAround(std::span<const glm::vec3> points);  ///< measured along the eyes

}  // namespace facefit
