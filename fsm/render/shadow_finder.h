#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <optional>

#include "fsm/base/side.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The ellipsoids that throw the face's shadows (see shaders/lighting.glsl), found in a head's mesh
/// and carried along with its movement. Made once per head, used every frame.
class ShadowFinder {
 public:
  ShadowFinder() = default;
  /// `rest` belongs to `topology`. A head without skin throws no shadow.
  ShadowFinder(const HeadTopology& topology, const HeadVertices& rest);

  /// Matrices, the first two from the frame of the vertices to where each ellipsoid is the unit
  /// sphere.
  struct Occluders {
    glm::mat4 skull;
    glm::mat4 nose;
    glm::mat3 turn;  ///< how the head has turned since the rest
  };
  Occluders Measure(const HeadVertices& vertices) const;
  /// The vertices that Measure looks at.
  void AppendVertices(std::vector<std::uint32_t>& out) const;

 private:
  /// Vertices that move with the skull alone, at least nearly: the tip of the nose and the
  /// outermost ones of the upper face.
  struct Anchors {
    std::uint32_t nose = 0;
    Sided<std::uint32_t> sides;
  };
  /// Origin midway between the sides; x to the left one, z towards the nose.
  glm::mat4 SpaceOf(const HeadVertices& vertices) const;

  std::optional<Anchors> anchors_;
  glm::mat4 rest_to_space_{1.0F};
};

}  // namespace fsm
