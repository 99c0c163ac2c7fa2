#pragma once

#include <string>

#include "face_fit/tflite/network.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// Sides of the networks' square inputs, pixels: detector, landmarks, segmentation.
inline constexpr int kDetectorPixels = 128, kLandmarkInputPixels = 192, kSegmentationPixels = 256;

/// The detector's cells: 16 x 16 with two boxes each, then 8 x 8 with six.
inline constexpr int kDetectorCells = 16 * 16 * 2 + 8 * 8 * 6;
/// Points of the landmark network with attention at the lips, an eye and its iris.
inline constexpr int kAttentionLipPoints = 80, kAttentionEyePoints = 71, kAttentionIrisPoints = 5;

// The outputs of the networks, by their order in the files. Right and left are the person's.

/// Of the detector: for each of its cells a box (DetectorBox), and how certain it is of it (a
/// logit).
enum DetectorOutput : std::size_t { kDetectorBoxes, kDetectorScores };
/// The numbers of one box: centre relative to the cell's and size, then x and y of six points, of
/// which two are used. Pixels of the input.
enum DetectorBox : std::size_t {
  kBoxCentre = 0,
  kBoxSize = 2,
  kBoxRightEye = 4,
  kBoxLeftEye = 6,
  kBoxNumbers = 16
};
/// Of the landmark network: x, y, z of 468 points, pixels of its input, and how certain it is that
/// they lie on a face (a logit).
enum LandmarkOutput : std::size_t { kLandmarkPoints, kLandmarkCertainty };
/// Of the segmentation: how much each pixel of its input belongs to a person, 0..1.
enum SegmentationOutput : std::size_t { kSegmentationPerson };
/// Of the landmark network with attention: 468 points (x, y, z), then points (x, y) of lips, eyes
/// and irises, all in pixels of its input, and how certain it is that there is a face (a logit).
enum AttentionOutput : std::size_t {
  kAttentionPoints,
  kAttentionLips,
  kAttentionRightEye,
  kAttentionLeftEye,
  kAttentionRightIris,
  kAttentionLeftIris,
  kAttentionCertainty
};

/// The networks of the npm packages @mediapipe/face_mesh and @mediapipe/selfie_segmentation (both
/// Apache-2.0), read from the unpacked packages.
struct FaceNetworks {
  tflite::Network detector;      ///< 128 x 128 in -1..1 -> DetectorOutput
  tflite::Network landmarks;     ///< 192 x 192 in 0..1 -> LandmarkOutput
  tflite::Network segmentation;  ///< 256 x 256 in 0..1 -> SegmentationOutput

  /// Loads them from `folder`; "" = NetworksFolder(). Errors: kUnavailable (says how to install
  /// them), kBadValue (the files are damaged).
  static vm::Result<FaceNetworks> Load(const std::string& folder);
};

/// Loads the landmark network with attention of the same package: 192 x 192 in 0..1 ->
/// AttentionOutput. Slower than the plain one, finer at lips and eyes. Errors: as
/// FaceNetworks::Load.
vm::Result<tflite::Network> LoadAttentionLandmarks(const std::string& folder);

/// Returns $GALATEA_NETWORKS, else $XDG_CACHE_HOME/galatea/networks, else
/// ~/.cache/galatea/networks.
std::string NetworksFolder();

}  // namespace facefit
