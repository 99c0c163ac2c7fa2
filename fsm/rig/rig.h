#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "fsm/rig/face_state.h"
#include "fsm/rig/pose.h"
#include "fsm/rig/rig_data.h"

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

/// What the steps read of one state.
struct RigInputs {
  Pose pose;
  std::vector<float> strengths;  ///< of each channel
  Sided<glm::mat3> eye_turn;     ///< rotations about EyeRig::pivot
};

/// The name of a step, as `fsm --describe` shows it.
std::string_view NameOf(RigStep step);

/// Moves a head: a pure function from FaceState to vertices, which takes the steps of its RigData
/// one after the other. Immutable; thread: any.
class Rig {
 public:
  /// REQUIRES: `data` has what RigData and its steps (RigStep) say they need. The bakers make it
  /// so; CheckAsset finds out of what comes from elsewhere.
  explicit Rig(RigData data);

  const RigData& data() const { return data_; }
  /// Whether the jaw carries a vertex as skin.
  static bool MovesWithJaw(const RigData& data, std::uint32_t vertex) {
    return data.bone[vertex] == Bone::kSkin && data.weights[vertex].jaw > 0.001f;
  }
  /// Fills `out` (resized as needed). Values out of range are clamped to what anatomy allows.
  /// `swings`: Simulation::offsets() of SpringRig::springs, or none where nothing swings.
  /// REQUIRES: one swing for each spring, or none at all.
  void Evaluate(const FaceState& state, HeadVertices& out,
                std::span<const glm::vec3> swings = {}) const;
  RigInputs InputsOf(const FaceState& state) const;
  /// Fills the members of HeadVertices other than positions and normals.
  void FindCreasesAndLids(const Pose& pose, HeadVertices& out) const;
  /// Measured before the head turns. All 0 if the head does not say where its lips are.
  MouthMeasure MeasureMouth(const FaceState& state) const;
  /// The same rig whose units move as another table says.
  Rig WithUnits(const UnitTable& units) const;

 private:
  struct Work;

  void Take(RigStep step, Work& work) const;
  Pose PoseOf(const FaceState& state) const;
  /// Rotation of the eyeball; heads with GazeRanges scale the gaze angle.
  glm::mat3 EyeTurn(const Pose& pose, Side side) const;
  void AddChannels(Work& work) const;
  void MoveTongue(Work& work) const;
  void MoveBones(Work& work) const;
  void TurnNeck(Work& work) const;

  RigData data_;
  // Vertices that the jaw, a bone and the step kNormals move, found from the data.
  std::vector<std::uint32_t> jawed_, rigid_, soft_;
  ChannelDrives drives_;
};

}  // namespace fsm
