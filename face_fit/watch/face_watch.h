#pragma once

#include <optional>

#include "face_fit/find/network/face_networks.h"
#include "face_fit/watch/face_measures.h"

namespace facefit {

/// Follows the largest face of a film from picture to picture. Not for several threads.
class FaceWatch {
 public:
  /// Both outlive it.
  FaceWatch(FaceNetworks& networks, Network& attention)
      : networks_(networks), attention_(attention) {}

  /// Returns nothing where no face is seen, or none that is certain (kCertainFace).
  std::optional<FaceMeasures> Look(const fsm::Image& picture);
  /// The points of the face in the last picture; nothing where Look returned nothing.
  const std::optional<AttentiveFace>& last() const { return last_; }

 private:
  /// Looks for the largest face, and for its points.
  void Find(const fsm::Image& picture);
  /// Looks for the points of a face in that part of a picture; sets `last_` to what it saw.
  void See(const fsm::Image& picture, const NetworkCrop& crop);

  FaceNetworks& networks_;
  Network& attention_;
  std::optional<AttentiveFace> last_;
  std::vector<glm::vec3> first_;  ///< points of the first face that was seen, millimetres
  /// The crop beside the line between the eyes, so that a mouth that opens does not move it.
  glm::vec2 eyes_to_middle_{0};
  float size_ = 0;
};

}  // namespace facefit
