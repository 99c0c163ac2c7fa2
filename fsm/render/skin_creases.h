#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "fsm/render/appearance.h"
#include "fsm/render/face_landmarks.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The creases of expression as a relief on a face's skin. Borrows its constructor's arguments.
class CreaseRelief {
 public:
  CreaseRelief(const FaceLandmarks& landmarks, const Appearance& appearance)
      : landmarks_(landmarks), skin_(appearance.skin) {}
  /// Returns the height above the skin, in millimetres, when all creases are at their deepest.
  float HeightAt(const glm::vec3& p) const;
  /// Returns false where no crease is within a few millimetres.
  bool MayCrease(const glm::vec3& p) const;

 private:
  float Furrow(float off, float width) const;
  // Each adds the creases of one region; `side` is the distance from the median, millimetres.
  void AddForehead(const glm::vec3& p, float side, float& height) const;
  void AddGlabella(const glm::vec3& p, float side, float& height) const;
  void AddBridge(const glm::vec3& p, float side, float& height) const;
  void AddCrowsFeet(const glm::vec3& p, float side, float& height) const;
  void AddNasolabial(const glm::vec3& p, float side, float& height) const;

  const FaceLandmarks& landmarks_;
  const Appearance::Skin& skin_;
};

/// How much each crease shows at each vertex, 0..1.
struct CreaseWeights {
  std::vector<glm::vec4> face;  ///< forehead, glabella, crow's feet, nasolabial
  std::vector<glm::vec3> more;  ///< nose, sides of the forehead; the left side's part in the depth
};
CreaseWeights WeighCreases(const HeadVertices& rest, const FaceLandmarks& landmarks,
                           const Appearance& appearance);

}  // namespace fsm
