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

/// The opening through which light comes into the mouth: how lips and teeth stand in a frame. Made
/// once per head, used every frame.
class MouthFinder {
 public:
  static constexpr int kColumns = 11;

  MouthFinder() = default;
  explicit MouthFinder(const HeadTopology& topology);

  /// In the mouth's own frame, millimetres: x from the agent's right corner (-) to the left one, y
  /// up along the upper incisors, origin midway between the corners.
  struct Opening {
    glm::mat4 to_mouth;  ///< from the frame of the vertices
    /// Places on the edge of the upper lip from -x to +x, then of the lower one likewise.
    std::array<glm::vec3, std::size_t{2} * kColumns> lips;
    glm::vec2 corners;  ///< x of the right and the left one; both lie at y = z = 0
    glm::vec2 teeth;    ///< heights of the upper and the lower incisors' edges
    /// Whether the lips meet in every column.
    bool IsShut() const;
  };
  /// Nothing where the head does not say where its lips part.
  std::optional<Opening> Measure(const HeadVertices& vertices) const;
  /// The vertices that Measure looks at.
  void AppendVertices(std::vector<std::uint32_t>& out) const;

 private:
  std::optional<MouthSlit> slit_;
};

}  // namespace fsm
