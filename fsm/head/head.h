#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fsm/head/face_state.h"

namespace fsm {

/// What a part of the mesh is made of; the renderer chooses its shading by it.
enum class Material {
  kSkin,
  kLip,
  kSclera,
  kIris,
  kPupil,
  kTeeth,
  kGum,
  kTongue,
  kMouthInside,
  kBrow,
  kLash,
  kHair,
  kCloth
};

/// The part of a head that never changes while it moves.
struct HeadTopology {
  struct Part {
    Material material;
    std::uint32_t first_index;  ///< into `indices`
    std::uint32_t index_count;  ///< multiple of 3
  };
  std::vector<std::uint32_t> indices;  ///< triangles, counter-clockwise seen from outside
  std::vector<Part> parts;
  std::vector<glm::vec3> albedo;  ///< per vertex, linear RGB 0..1
  std::vector<float> occlusion;   ///< per vertex, 0 = fully shut off from light, 1 = open
};

/// Vertex positions and normals of one state. Reused from frame to frame by the caller.
struct HeadVertices {
  std::vector<glm::vec3>
      position;  ///< N x 3 float, millimetres; x to the viewer's right, y up, z to the
                 ///< viewer; origin midway between the two ear canals (tragi)
  std::vector<glm::vec3> normal;  ///< N x 3 float, unit length
};

/// A head with its anatomy: a pure function from FaceState to vertices, head rotation included,
/// figure placement (agent_*) and camera not. Immutable after construction; safe to share.
class Head {
 public:
  virtual ~Head() = default;
  /// The first, generic head. Deterministic. Throws std::runtime_error if a table is damaged.
  static std::unique_ptr<Head> MakeGeneric();

  virtual const HeadTopology& topology() const = 0;
  /// Fills `out` (resized as needed). Values out of range are clamped to what anatomy allows.
  virtual void Evaluate(const FaceState& state, HeadVertices& out) const = 0;
  /// The mouth of a state, measured on the vertices Evaluate would give.
  virtual MouthMeasure MeasureMouth(const FaceState& state) const = 0;
};

}  // namespace fsm
