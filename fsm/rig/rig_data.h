#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fsm/rig/action_units.h"
#include "fsm/rig/lid_rig.h"
#include "fsm/rig/lip_rig.h"
#include "fsm/rig/skin_weights.h"
#include "fsm/rig/tooth_arch.h"

namespace fsm {

class Deformation;

/// The hinge of the built-in heads' jaw: an axis along x.
inline constexpr glm::vec3 kJawHinge{0, -4, -3};
/// The point the head turns about, in the upper neck.
inline constexpr glm::vec3 kNeckPivot{0, -85, -28};

/// By how much something moves a vertex at full strength, millimetres.
struct Displacement {
  std::uint32_t vertex;
  glm::vec3 by;
};

/// One thing that can be asked of a face, and what it displaces. Channels add up.
struct Channel {
  enum class Kind : std::uint8_t {
    kUnit,  ///< `number`: of FACS
    kMouth  ///< `number`: index into FaceState::mouth
  };
  Kind kind;
  std::uint16_t number;
  std::uint8_t side = 0;  ///< of a unit: 0 the agent's right, 1 the left
  std::vector<Displacement> moves;
};

/// How far an eye turns for a gaze: in proportion up to `gaze_deg`, where it has turned by `turn`
/// (degrees; where shapes do it, the weight of one). VRM 0.x and 1.0, "lookAt".
struct LookRange {
  float gaze_deg = 90, turn = 10;
};
struct LookRanges {
  LookRange inner, outer, up, down;
};

/// A vertex of skin that stays outside an eyeball, whatever moves it.
struct BallLid {
  std::uint32_t vertex;
  std::uint8_t side;  ///< 0 the agent's right, 1 the left
  float least;        ///< distance from the ball's centre, millimetres
};

/// A vertex that lies on the teeth and is held off them.
struct TeethContact {
  std::uint32_t vertex;
  float upper_gap, lower_gap;  ///< least distances from either arch, by the distance at rest
};

/// The steps by which a state becomes vertices, in the order of RigData::steps. Each sees what
/// those before it made.
enum class RigStep : std::uint8_t {
  kChannels,     ///< what units and mouth parameters displace
  kDeformation,  ///< what RigData::deformation does
  kLids,         ///< lids turn about the eyes, over the cornea
  kLidsOnBalls,  ///< what was outside an eyeball stays outside
  kJaw,          ///< skin goes with the jaw, by its weights
  kTeeth,        ///< lips are held off the teeth
  kLips,         ///< lips that would cross meet, and close as far as they are sealed
  kTongue,       ///< the tongue finds its way between teeth and lips
  kBones,        ///< jaw and eyes, with what is fixed to them
  kNeck,         ///< the head turns and goes forward
  kNormals       ///< the skin's light follows its form
};

/// How a head moves: plain data, in the frame of HeadVertices.
struct RigData {
  std::vector<RigStep> steps;
  std::vector<glm::vec3> rest, rest_normal;  ///< per vertex
  std::vector<Bone> bone;                    ///< per vertex
  std::vector<SkinWeights> weights;          ///< per vertex
  /// Triangles whose corners take their normals from what they become, three indices each; all
  /// other vertices keep theirs, turned with their bone.
  std::vector<std::uint32_t> soft_triangles;
  /// Of each vertex the one whose normal it shares, where a texture is sewn together; or none.
  std::vector<std::uint32_t> normal_twin;

  UnitTable units;            ///< how units combine, and what they do beside displacing skin
  std::optional<int> person;  ///< whose two sides differ: see UnitTable::MakeAsymmetric
  /// Whether the displacements of units follow from `units` and `weights` (UnitChannels); else
  /// they are the head's own.
  bool units_by_place = false;
  std::vector<Channel> channels;
  std::shared_ptr<const Deformation> deformation;

  LidRig lids;
  std::vector<BallLid> ball_lids;
  LipRig lips;
  ToothArch upper_teeth{}, lower_teeth{};
  std::vector<TeethContact> teeth_contacts;
  glm::vec3 jaw_hinge = kJawHinge;         ///< the jaw's axis goes through it along x
  std::array<glm::vec3, 2> eye_pivot{};    ///< what the eyes turn about: right, left
  std::array<glm::vec3, 2> ball_centre{};  ///< of what `ball_lids` stay outside of
  std::optional<LookRanges> look;          ///< else eyes turn as far as the gaze does
  /// How deep forehead, glabella, crow's feet and nasolabial fold crease at rest, and a factor on
  /// all creases; nothing where the head shows none.
  std::optional<std::array<float, 4>> creases;
  float crease_depth = 1;
};

/// The channels of the units' table for vertices of skin with these weights.
std::vector<Channel> UnitChannels(const UnitTable& units, std::span<const Bone> bones,
                                  std::span<const SkinWeights> weights);

/// Of vertices that stay where they are.
RigData StillRig(std::vector<glm::vec3> position, std::vector<glm::vec3> normal);

}  // namespace fsm
