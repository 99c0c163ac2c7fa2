#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "face_fit/find/network/found_face.h"

namespace facefit {

class FaceNetworks;

/// Returns all faces, largest first. Searches the whole image, and its parts unless it shows a
/// large face. Drops uncertain faces if at least one of several is certain.
std::vector<FoundFace> FindFaces(FaceNetworks& networks, const fsm::Image& image);

/// Returns Landmarks::points as those of FoundFace. `crop`: what the network was shown.
PerPoint<glm::vec3> PointsInImage(PerPoint<glm::vec3> points, const NetworkCrop& crop);

/// Returns the square around a face's points to show to the landmark network, turned as the line of
/// its eyes. `axes_rad`: angle of the box that measures the points.
NetworkCrop CropAround(std::span<const glm::vec3> points, float axes_rad);
NetworkCrop CropAround(std::span<const glm::vec3> points);  ///< measured along the eyes

}  // namespace facefit
