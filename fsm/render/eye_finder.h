#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/rig/head.h"

namespace fsm {

/// What the eye shader needs to know of one eyeball, in the frame of the measured vertices.
struct MeasuredEye {
  glm::vec3 centre{0.0f};
  float radius = 12.0f;
  glm::vec3 gaze{0.0f, 0.0f, 1.0f};  ///< unit vector from the centre through the pupil
  float iris_radius = 5.8f;
  float upper_lid_y = 0;  ///< heights of the lid margins above and below the pupil
  float lower_lid_y = 0;
};

/// Finds eyeballs and lid margins in any head's mesh: balls are fitted to the sclera's vertices,
/// margins are the skin closest to them. Made once per head, used every frame.
class EyeFinder {
 public:
  /// REQUIRES: `rest` belongs to `surface`. A head without a kSclera part has no eyes.
  EyeFinder(const HeadSurface& surface, const HeadVertices& rest);
  bool found() const { return !white_.right.empty() && !white_.left.empty(); }
  /// REQUIRES: found().
  Sided<MeasuredEye> Measure(const HeadVertices& vertices) const;
  /// Appends the vertices that Measure reads.
  void AppendVertices(std::vector<std::uint32_t>& out) const;

 private:
  Sided<std::vector<std::uint32_t>> white_, iris_, upper_rim_, lower_rim_;
};

}  // namespace fsm
