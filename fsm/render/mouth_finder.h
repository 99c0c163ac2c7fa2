#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "fsm/rig/head.h"

namespace fsm {

/// Measures the opening through which light enters the mouth: lips and teeth in a frame. Made once
/// per head, used every frame.
class MouthFinder {
 public:
  static constexpr int kColumns = 11;  ///< of points on the lips; the shader has it as well

  explicit MouthFinder(const MouthVertices& mouth);

  /// The opening in the mouth's own frame, millimetres: x from the agent's right corner (-) to the
  /// left one, y up along the upper incisors, origin midway between the corners.
  struct Opening {
    glm::mat4 to_mouth;  ///< from the frame of the vertices
    /// Points on the edge of the upper lip from -x to +x, then on the lower lip likewise.
    std::array<glm::vec3, std::size_t{2} * kColumns> lips;
    glm::vec2 corners;  ///< x of the right and the left corner; both lie at y = z = 0
    glm::vec2 teeth;    ///< heights of the upper and the lower incisors' edges
    /// Tells whether the lips touch in every column.
    bool IsShut() const;
  };
  /// Returns nothing if the head has no seam of the lips or no incisors.
  std::optional<Opening> Measure(const HeadVertices& vertices) const;
  /// Appends the vertices that Measure reads.
  void AppendVertices(std::vector<std::uint32_t>& out) const;

 private:
  std::optional<MouthVertices> mouth_;
};

}  // namespace fsm
