#pragma once

#include <string>

#include "face_fit/tflite/network.h"
#include "vm_protocol/core/result.h"

namespace facefit {

using tflite::Network;

/// The sides of the square pictures that the networks are shown, in pixels: those that find faces,
/// their points, and figures.
inline constexpr int kDetectorPixels = 128, kPointsPixels = 192, kFigurePixels = 256;

/// The networks of the npm packages @mediapipe/face_mesh and @mediapipe/selfie_segmentation, read
/// as they are unpacked (both Apache-2.0).
struct FaceNetworks {
  Network detector;      ///< 128 x 128 in -1..1 -> 896 boxes and their scores
  Network landmarks;     ///< 192 x 192 in 0..1 -> 468 points in pixels, and whether there is a face
  Network segmentation;  ///< 256 x 256 in 0..1 -> how much each pixel belongs to a person

  /// From `folder`, "" = where scripts/face_networks.sh puts them. Errors: kUnavailable (says how
  /// to install them), kBadValue (the files are not what they should be).
  static vm::Result<FaceNetworks> Load(const std::string& folder);
};

/// The landmark network with attention, of the same package: 192 x 192 in 0..1 -> the outputs
/// below. Slower than the plain one, finer at lips and eyes. Errors as of FaceNetworks::Load.
vm::Result<Network> LoadAttentionLandmarks(const std::string& folder);
/// Its outputs: 468 points (x, y, z), then points (x, y) of the lips, the eyes and the irises, all
/// in pixels of what it was shown, and whether there is a face. Right and left are the person's.
enum AttentionOutput : std::size_t {
  kAttentionMesh,
  kAttentionLips,
  kAttentionRightEye,
  kAttentionLeftEye,
  kAttentionRightIris,
  kAttentionLeftIris,
  kAttentionFlag
};

/// $GALATEA_NETWORKS, else $XDG_CACHE_HOME/galatea/networks, else ~/.cache/galatea/networks.
std::string NetworksFolder();

}  // namespace facefit
