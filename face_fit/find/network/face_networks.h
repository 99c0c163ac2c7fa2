#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "face_fit/find/network/network_points.h"
#include "face_fit/image/raster.h"
#include "face_fit/tflite/network.h"
#include "face_fit/tflite/operators.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// Sides of the networks' square inputs, pixels: detector, landmarks, segmentation.
inline constexpr int kDetectorPixels = 128, kLandmarkInputPixels = 192, kSegmentationPixels = 256;

/// A face found by the detector; places and sizes 0..1 of the square that it was shown.
struct FaceBox {
  glm::vec2 centre, size;
  float score;                    ///< 0..1
  std::array<glm::vec2, 2> eyes;  ///< the person's right and left
  float Area() const { return size.x * size.y; }
};

/// The points of a face, 0..1 of the square that the network was shown; z in the same unit towards
/// the viewer.
struct Landmarks {
  PerPoint<glm::vec3> points;
  float certainty_logit;  ///< how certain it is that they lie on a face
};

/// The networks of the npm packages @mediapipe/face_mesh and @mediapipe/selfie_segmentation (both
/// Apache-2.0). Each looks at a square of RGB pixels. Thread: one at a time.
class FaceNetworks {
 public:
  /// Loads them from the unpacked packages in `folder`; "" = $GALATEA_NETWORKS, else
  /// $XDG_CACHE_HOME/galatea/networks, else ~/.cache/galatea/networks. Errors: kUnavailable (says
  /// how to install them), kBadValue (the files are damaged).
  static vm::Result<FaceNetworks> Load(const std::string& folder);

  /// Returns boxes with a score of at least 0.5, several of each face. `pixels`: kDetectorPixels,
  /// -1..1.
  std::vector<FaceBox> Detect(std::span<const float> pixels);
  /// `pixels`: kLandmarkInputPixels, 0..1.
  Landmarks Locate(std::span<const float> pixels);
  /// Returns how much each pixel belongs to a person. `pixels`: kSegmentationPixels, 0..1.
  Mask SegmentPerson(std::span<const float> pixels);

 private:
  FaceNetworks(tflite::Network detector, tflite::Network landmarks, tflite::Network segmentation)
      : detector_(std::move(detector)),
        landmarks_(std::move(landmarks)),
        segmentation_(std::move(segmentation)) {}

  tflite::Network detector_, landmarks_, segmentation_;
};

/// Reads a network of @mediapipe/face_mesh. `side`: of its square input, pixels; `outputs`: count
/// of the numbers of each output. Errors: as FaceNetworks::Load.
vm::Result<tflite::Network> ReadFaceMeshNetwork(const std::string& folder, const char* name,
                                                std::size_t side,
                                                std::initializer_list<std::size_t> outputs);
/// Returns the points of an output: x, y, z of each in pixels of a square of kLandmarkInputPixels.
PerPoint<glm::vec3> PointsOf(std::span<const float> output);

/// Returns the probability, 0..1, that a network gives as a logit.
inline float Probability(float logit) { return tflite::op::Logistic::Apply(logit); }

}  // namespace facefit
