#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "fsm/render/appearance.h"
#include "fsm/render/face_landmarks.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The creases of expression as a relief on the skin of a face. What it is made of outlives it.
class CreaseRelief {
 public:
  CreaseRelief(const FaceLandmarks& landmarks, const Appearance& appearance)
      : landmarks_(landmarks), skin_(appearance.skin) {}
  /// How high above the skin a place lies when all creases are at their deepest, millimetres.
  float HeightAt(const glm::vec3& place) const;
  /// False where no crease is within a few millimetres.
  bool MayCrease(const glm::vec3& place) const;

 private:
  float Furrow(float off, float width) const;
  // The creases of one region; `side` is how far the place is from the median. Each adds to what
  // there is.
  void AddForehead(const glm::vec3& p, float side, float& height) const;
  void AddGlabella(const glm::vec3& p, float side, float& height) const;
  void AddBridge(const glm::vec3& p, float side, float& height) const;
  void AddCrowsFeet(const glm::vec3& p, float side, float& height) const;
  void AddNasolabial(const glm::vec3& p, float side, float& height) const;

  const FaceLandmarks& landmarks_;
  const decltype(Appearance::skin)& skin_;
};

/// How much each crease shows at the vertices, 0..1.
struct CreaseWeights {
  std::vector<glm::vec4> face;           ///< forehead, glabella, crow's feet, nasolabial
  std::vector<glm::vec2> nose_and_left;  ///< nose; to which part it is the left side that creases
};
CreaseWeights WeighCreases(const HeadVertices& rest, const FaceLandmarks& landmarks);

}  // namespace fsm
