#pragma once

#include <optional>

#include "face_fit/find/network/face_networks.h"
#include "face_fit/watch/face_measures.h"

namespace facefit {

/// Follows the largest face of a film from frame to frame. Thread: one at a time.
class FaceWatch {
 public:
  /// Both must outlive this object.
  FaceWatch(FaceNetworks& networks, AttentionNetwork& attention)
      : networks_(networks), attention_(attention) {}

  /// Measures the face in the next frame; nothing if none is seen with kCertainFace.
  std::optional<FaceMeasures> MeasureNext(const fsm::Image& frame);
  /// Returns the points of the face in the last frame; nothing where MeasureNext did.
  const std::optional<AttentiveFace>& last() const { return last_; }

 private:
  /// Finds the largest face, its crop and its points.
  void Find(const fsm::Image& frame);
  /// Finds the points of a face in a crop of a frame; sets last_, or resets it if uncertain.
  void FindPointsIn(const fsm::Image& frame, const NetworkCrop& crop);

  FaceNetworks& networks_;
  AttentionNetwork& attention_;
  std::optional<AttentiveFace> last_;
  std::vector<glm::vec3> first_;  ///< PointsInMm of the first face seen
  /// The crop relative to the line between the eyes, so that an opening mouth does not move it.
  glm::vec2 eyes_to_middle_{0};
  float size_ = 0;
};

}  // namespace facefit
