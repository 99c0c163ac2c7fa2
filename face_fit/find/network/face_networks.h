#pragma once

#include <string>

#include "face_fit/tflite/network.h"
#include "vm_protocol/core/result.h"

namespace facefit {

using tflite::Network;

/// Sides of the networks' square inputs, pixels: detector, landmarks, segmentation.
inline constexpr int kDetectorPixels = 128, kPointsPixels = 192, kFigurePixels = 256;

/// The networks of the npm packages @mediapipe/face_mesh and @mediapipe/selfie_segmentation (both
/// Apache-2.0), read from the unpacked packages.
struct FaceNetworks {
  Network detector;      ///< 128 x 128 in -1..1 -> 896 boxes and their scores
  Network landmarks;     ///< 192 x 192 in 0..1 -> 468 points in pixels, and whether there is a face
  Network segmentation;  ///< 256 x 256 in 0..1 -> how much each pixel belongs to a person

  /// Loads them from `folder`; "" = NetworksFolder(). Errors: kUnavailable (says how to install
  /// them), kBadValue (the files are damaged).
  static vm::Result<FaceNetworks> Load(const std::string& folder);
};

/// Loads the landmark network with attention of the same package: 192 x 192 in 0..1 -> the outputs
/// below. Slower than the plain one, finer at lips and eyes. Errors: as FaceNetworks::Load.
vm::Result<Network> LoadAttentionLandmarks(const std::string& folder);
/// Its outputs: 468 points (x, y, z), then points (x, y) of lips, eyes and irises, all in pixels of
/// its input, and whether there is a face. Right and left are the person's.
enum AttentionOutput : std::size_t {
  kAttentionMesh,
  kAttentionLips,
  kAttentionRightEye,
  kAttentionLeftEye,
  kAttentionRightIris,
  kAttentionLeftIris,
  kAttentionFlag
};

/// Returns $GALATEA_NETWORKS, else $XDG_CACHE_HOME/galatea/networks, else
/// ~/.cache/galatea/networks.
std::string NetworksFolder();

}  // namespace facefit
