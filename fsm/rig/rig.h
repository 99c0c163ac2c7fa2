#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/rig/face_state.h"
#include "fsm/rig/pose.h"
#include "fsm/rig/rig_data.h"
#include "fsm/rig/rig_steps.h"

namespace fsm {

/// Vertex positions and normals of one state. The caller reuses them from frame to frame.
struct HeadVertices {
  /// N x 3 float, millimetres; x to the viewer's right, y up, z to the viewer; origin midway
  /// between the two ear canals (tragi).
  std::vector<glm::vec3> position;
  std::vector<glm::vec3> normal;  ///< N x 3 float, unit length
  Creases creases{};
  Sided<float> lids_shut;  ///< 0 = as at rest, 1 = fully shut
};

/// The values that a rig computes from one state before it takes the steps.
struct RigInputs {
  Pose pose;
  step::StepState state;
  std::vector<float> strengths;  ///< by channel
};

/// Moves a head: a pure function from FaceState to vertices, which takes the steps of its RigData
/// in order. Immutable; thread: any.
class Rig {
 public:
  /// REQUIRES: `data` meets what RigData and its steps (RigStep) say they need. The bakers
  /// guarantee it; CheckAsset checks data from elsewhere.
  explicit Rig(RigData data);

  const RigData& data() const { return data_; }
  /// Fills `out` (resized as needed). Values out of range are clamped to what anatomy allows.
  /// `spring_offsets`: Simulation::offsets() of SpringRig::springs, or empty if nothing swings.
  /// REQUIRES: one offset for each spring, or none.
  void Evaluate(const FaceState& state, HeadVertices& out,
                std::span<const glm::vec3> spring_offsets = {}) const;
  /// Fills `inputs`, whose memory is reused from frame to frame.
  void ComputeInputs(const FaceState& state, RigInputs& inputs) const;
  /// Measures the mouth before the head turns. Returns zeros if the head has no seam or corners of
  /// the mouth.
  MouthMeasure MeasureMouth(const FaceState& state) const;
  /// Returns the same rig with action units that move as another table says.
  Rig WithUnits(const UnitTable& units) const;

 private:
  /// Fills all members of HeadVertices but positions and normals.
  void ComputeCreasesAndLids(const Pose& pose, HeadVertices& out) const;

  RigData data_;
  UnitCombiner combiner_;
  MovedVertices moved_;
  ChannelStrengths drives_;
};

}  // namespace fsm
