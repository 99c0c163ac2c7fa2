#pragma once

#include <string>

#include "face_fit/net/network.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// The networks of the npm packages @mediapipe/face_mesh and @mediapipe/selfie_segmentation, read
/// as they are unpacked (both Apache-2.0).
struct FaceNetworks {
  Network detector;   ///< 128 x 128 in -1..1 -> 896 boxes and their scores
  Network landmarks;  ///< 192 x 192 in 0..1 -> 468 points in pixels, and whether there is a face
  Network figure;     ///< 256 x 256 in 0..1 -> how much each pixel belongs to a person

  /// From `folder`, "" = where scripts/face_networks.sh puts them. Errors: kUnavailable (says how
  /// to install them), kBadValue (the files are not what they should be).
  static vm::Result<FaceNetworks> Load(const std::string& folder);
};

/// $GALATEA_NETWORKS, else $XDG_CACHE_HOME/galatea/networks, else ~/.cache/galatea/networks.
std::string NetworksFolder();

}  // namespace facefit
