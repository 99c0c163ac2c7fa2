#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <optional>

#include "fsm/base/side.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The ellipsoids that cast the face's shadows (see shaders/lighting.glsl), found in a head's mesh
/// and carried along as it moves. Made once per head, used every frame.
class ShadowFinder {
 public:
  /// REQUIRES: `rest` belongs to `surface`. A head without skin casts no shadow.
  ShadowFinder(const HeadSurface& surface, const HeadVertices& rest);

  /// `skull` and `nose` map the frame of the vertices so that each ellipsoid is the unit sphere.
  struct Occluders {
    glm::mat4 skull;
    glm::mat4 nose;
    glm::mat3 rotation;  ///< of the head since the rest state
  };
  Occluders Measure(const HeadVertices& vertices) const;
  /// Appends the vertices that Measure reads.
  void AppendVertices(std::vector<std::uint32_t>& out) const;

 private:
  /// Vertices that move almost only with the skull: the tip of the nose and the outermost vertices
  /// of the upper face.
  struct Anchors {
    std::uint32_t nose = 0;
    Sided<std::uint32_t> sides;
  };
  /// Returns the head's frame: origin midway between the sides, x to the left one, z to the nose.
  glm::mat4 SpaceOf(const HeadVertices& vertices) const;

  std::optional<Anchors> anchors_;
  glm::mat4 rest_to_space_{1.0f};
};

}  // namespace fsm
