#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "fsm/rig/channel.h"
#include "fsm/rig/lid_rig.h"
#include "fsm/rig/lip_rig.h"
#include "fsm/rig/normals.h"
#include "fsm/rig/skin_weights.h"
#include "fsm/rig/spring.h"
#include "fsm/rig/teeth_rig.h"
#include "fsm/rig/unit_table.h"

namespace fsm {

/// The hinge of the built-in heads' jaw: an axis along x.
inline constexpr glm::vec3 kJawHinge{0, -4, -3};
/// The point the head turns about, in the upper neck.
inline constexpr glm::vec3 kNeckPivot{0, -85, -28};

/// The rotation of an eye grows with the gaze up to `gaze_deg`, where it is `turn` (degrees; the
/// weight of a shape where shapes turn the eyes). VRM 0.x and 1.0, "lookAt".
struct GazeRange {
  float gaze_deg = 90, turn = 10;
};
struct GazeRanges {
  GazeRange inner, outer, up, down;
};

/// The steps that compute vertices from a state; RigData::steps lists those of a head in order.
/// Each works on the result of the steps before it.
enum class RigStep : std::uint8_t {
  kChannels,     ///< units and mouth parameters displace vertices
  kLids,         ///< lids turn about the eyes, over the cornea
  kLidsOnBalls,  ///< what was outside an eyeball stays outside
  kJaw,          ///< skin goes with the jaw, by its weights
  kJawByChin,    ///< the jaw opens and sways as far as JawRig::chin has gone
  kTeeth,        ///< lips are held off the teeth
  kLips,         ///< lips that would cross meet, and close as far as they are sealed
  kOwnForm,      ///< vertices go by ProxyForm::to_own
  kTongue,       ///< the tongue finds its way between teeth and lips
  kBones,        ///< jaw and eyes, with what is fixed to them
  kNeck,         ///< the head turns and goes forward
  kSprings,      ///< what is soft swings, where a simulation says how far
  kNormals       ///< normals are found from the moved skin
};

/// The jaw: its axis goes through the hinge along x.
struct JawRig {
  glm::vec3 hinge = kJawHinge;
  std::uint32_t chin = 0;  ///< the vertex that kJawByChin looks at
};

/// What the eyes turn about, and how far.
struct EyeRig {
  Sided<glm::vec3> pivot;
  std::optional<GazeRanges> gaze_ranges;  ///< none: the eyes turn by the gaze angle
};

/// The other head that a transferred rig was taken from. Both arrays are per vertex, and empty
/// where the rig is the head's own.
struct ProxyForm {
  /// Position on the other head; the steps before kOwnForm move it there.
  std::vector<glm::vec3> rest;
  /// Offset from the proxy's neutral position to this head's rest.
  std::vector<glm::vec3> to_own;
};

/// How the skin creases, Crease by Crease.
struct CreaseRig {
  std::optional<std::array<float, kLastingCreases>> at_rest;  ///< none: no creases are shown
  float depth = 1;                                            ///< a factor on all of them
};

/// How a head moves: plain data, in the frame of HeadVertices. Members that all steps read come
/// before those of single steps.
struct RigData {
  std::vector<RigStep> steps;
  std::vector<glm::vec3> rest, rest_normal;  ///< per vertex
  std::vector<Bone> bone;                    ///< per vertex
  std::vector<SkinWeights> weights;          ///< per vertex
  UnitTable units;  ///< how units combine, and what they do beside displacing skin
  std::optional<int> asymmetry_seed;  ///< of UnitTable::MakeAsymmetric; none: both sides alike
  /// Whether the displacements of units follow from `units` and `weights` (UnitChannels); else
  /// they are the head's own.
  bool units_by_place = false;
  CreaseRig creases;

  std::vector<Channel> channels;
  LidRig lids;
  BallLids ball_lids;
  JawRig jaw;
  TeethRig teeth;
  LipRig lips;
  ProxyForm proxy;
  EyeRig eyes;
  SpringRig swing;
  NormalRig normals;

  /// The positions that the steps start from.
  const std::vector<glm::vec3>& Start() const { return proxy.rest.empty() ? rest : proxy.rest; }
};

/// The rig of some of the vertices, in the order of `vertices`, which holds those that steps look
/// at (StepVertices). Normals of soft triangles are left at rest.
RigData OnlyVertices(const RigData& data, std::span<const std::uint32_t> vertices);
/// The vertices by whose places the steps find those of others: where lips meet, the chin.
std::vector<std::uint32_t> StepVertices(const RigData& data);

/// The rig of vertices that stay where they are.
RigData StillRig(std::vector<glm::vec3> position, std::vector<glm::vec3> normal);

}  // namespace fsm
