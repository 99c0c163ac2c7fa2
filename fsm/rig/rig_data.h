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

/// How far an eye turns for a gaze: in proportion up to `gaze_deg`, where it has turned by `turn`
/// (degrees; where shapes do it, the weight of one). VRM 0.x and 1.0, "lookAt".
struct LookRange {
  float gaze_deg = 90, turn = 10;
};
struct LookRanges {
  LookRange inner, outer, up, down;
};

/// The steps by which a state becomes vertices, in the order of RigData::steps. Each sees what
/// those before it made.
enum class RigStep : std::uint8_t {
  kChannels,     ///< what units and mouth parameters displace
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
  kNormals       ///< the skin's light follows its form
};

/// The jaw: its axis goes through the hinge along x.
struct JawRig {
  glm::vec3 hinge = kJawHinge;
  std::uint32_t chin = 0;  ///< the vertex that kJawByChin looks at
};

/// What the eyes turn about, and how far.
struct EyeRig {
  Sided<glm::vec3> pivot;
  std::optional<LookRanges> look;  ///< else as far as the gaze does
};

/// Where a rig was taken over from another head. Both are per vertex, or empty where it was not.
struct ProxyForm {
  /// Its place on the other head, where the steps before kOwnForm move it among the other's lids,
  /// lips and teeth.
  std::vector<glm::vec3> rest;
  /// What leads from there, moved to where nothing is asked, to RigData::rest.
  std::vector<glm::vec3> to_own;
};

/// How the skin creases, Crease by Crease.
struct CreaseRig {
  std::optional<std::array<float, kLastingCreases>> at_rest;  ///< nothing where the head shows none
  float depth = 1;                                            ///< a factor on all of them
};

/// How a head moves: plain data, in the frame of HeadVertices. What all steps look at, then what
/// belongs to one of them.
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

  /// Where the steps begin.
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
