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

/// Vertex positions and normals of one state. Reused from frame to frame by the caller.
struct HeadVertices {
  std::vector<glm::vec3>
      position;  ///< N x 3 float, millimetres; x to the viewer's right, y up, z to the
                 ///< viewer; origin midway between the two ear canals (tragi)
  std::vector<glm::vec3> normal;  ///< N x 3 float, unit length
  Creases creases{};
  Sided<float> lids_shut;  ///< 0 = as at rest, 1 = wholly
};

/// What a rig makes of one state before it takes the steps.
struct RigInputs {
  Pose pose;
  step::StepState state;
  std::vector<float> strengths;  ///< of each channel
};

/// Moves a head: a pure function from FaceState to vertices, which takes the steps of its RigData
/// one after the other. Immutable; thread: any.
class Rig {
 public:
  /// REQUIRES: `data` has what RigData and its steps (RigStep) say they need. The bakers make it
  /// so; CheckAsset finds out of what comes from elsewhere.
  explicit Rig(RigData data);

  const RigData& data() const { return data_; }
  /// Fills `out` (resized as needed). Values out of range are clamped to what anatomy allows.
  /// `swings`: Simulation::offsets() of SpringRig::springs, or none where nothing swings.
  /// REQUIRES: one swing for each spring, or none at all.
  void Evaluate(const FaceState& state, HeadVertices& out,
                std::span<const glm::vec3> swings = {}) const;
  /// Fills `inputs`, which are reused from frame to frame.
  void FindInputs(const FaceState& state, RigInputs& inputs) const;
  /// Measured before the head turns. All 0 if the head does not say where its lips are.
  MouthMeasure MeasureMouth(const FaceState& state) const;
  /// The same rig whose units move as another table says.
  Rig WithUnits(const UnitTable& units) const;

 private:
  /// Fills the members of HeadVertices other than positions and normals.
  void FindCreasesAndLids(const Pose& pose, HeadVertices& out) const;

  RigData data_;
  MovedVertices moved_;
  ChannelDrives drives_;
};

}  // namespace fsm
