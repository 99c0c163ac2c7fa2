#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fsm/rig/action_units.h"
#include "fsm/rig/lid_rig.h"
#include "fsm/rig/lip_rig.h"
#include "fsm/rig/skin_weights.h"
#include "fsm/rig/spring.h"
#include "fsm/rig/tooth_arch.h"

namespace fsm {

/// The hinge of the built-in heads' jaw: an axis along x.
inline constexpr glm::vec3 kJawHinge{0, -4, -3};
/// The point the head turns about, in the upper neck.
inline constexpr glm::vec3 kNeckPivot{0, -85, -28};

/// How far something moves a vertex at full strength, millimetres.
struct Displacement {
  std::uint32_t vertex;
  glm::vec3 by;
};

/// A number of a state by which a face moves.
struct Drive {
  enum class Kind : std::uint8_t {
    kUnit,         ///< `number`: of FACS; its strength beside the others (UnitTable::Combine)
    kAskedUnit,    ///< the same as the state asks for it, 0..2, whatever else is asked
    kMouth,        ///< `number`: index into FaceState::mouth; of the jaw what units leave to it
    kSpokenMouth,  ///< what FaceState::mouth asks beyond FaceState::mouth_by_hand
    kHandMouth,    ///< `number`: index into FaceState::mouth_by_hand
    kBlink,        ///< how far lids close beyond what units ask, 0..1
    kGazeUp,       ///< of an eye, degrees
    kGazeRight     ///< of an eye, to the viewer's right, degrees
  };
  enum class WhichSide : std::uint8_t {
    kRight,
    kLeft,
    kStronger  ///< the greater of both
  };
  enum class Half : std::uint8_t {
    kWhole,
    kPositive,  ///< the value where it is above 0, else 0
    kNegative   ///< what it is below 0, as a positive number, else 0
  };
  static WhichSide OnlyOf(Side one) {
    return one == Side::kRight ? WhichSide::kRight : WhichSide::kLeft;
  }

  Kind kind;
  std::uint16_t number = 0;
  WhichSide side = WhichSide::kRight;  ///< of units, blinks and gazes
  Half half = Half::kWhole;
};

/// What moves together, and how strongly in which state: as much as its drivers say in sum, within
/// limits, and by whether the lips are sealed. Channels add up.
struct Channel {
  struct Driver {
    Drive drive;
    float gain = 1;
  };
  std::vector<Driver> drivers;
  float least = -std::numeric_limits<float>::infinity();
  float most = std::numeric_limits<float>::infinity();
  float open_factor = 1, sealed_factor = 1;  ///< on the strength, while lips are open and sealed
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
  Side side;
  float least;  ///< distance from the ball's centre, millimetres
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
  kLids,         ///< lids turn about the eyes, over the cornea
  kLidsOnBalls,  ///< what was outside an eyeball stays outside
  kJaw,          ///< skin goes with the jaw, by its weights
  kJawByChin,    ///< the jaw opens and sways as far as RigData::chin has gone
  kTeeth,        ///< lips are held off the teeth
  kLips,         ///< lips that would cross meet, and close as far as they are sealed
  kOwnForm,      ///< vertices go by RigData::own_form
  kTongue,       ///< the tongue finds its way between teeth and lips
  kBones,        ///< jaw and eyes, with what is fixed to them
  kNeck,         ///< the head turns and goes forward
  kSprings,      ///< what is soft swings, where a simulation says how far
  kNormals       ///< the skin's light follows its form
};

/// How a head moves: plain data, in the frame of HeadVertices.
struct RigData {
  std::vector<RigStep> steps;
  std::vector<glm::vec3> rest, rest_normal;  ///< per vertex
  /// Where this rig was taken over from another head: per vertex its place on that one, where the
  /// steps before kOwnForm move it among the other's lids, lips and teeth, and what leads from
  /// there, moved to where nothing is asked, to `rest`. Else both are empty.
  std::vector<glm::vec3> proxy_rest, own_form;
  std::vector<Bone> bone;            ///< per vertex
  std::vector<SkinWeights> weights;  ///< per vertex
  /// Triangles whose corners take their normals from what they become, three indices each; all
  /// other vertices keep theirs, turned with their bone.
  std::vector<std::uint32_t> soft_triangles;
  /// Per vertex the one whose normal it shares, where a texture is sewn together; may be empty.
  std::vector<std::uint32_t> normal_twin;

  UnitTable units;            ///< how units combine, and what they do beside displacing skin
  std::optional<int> person;  ///< whose two sides differ: see UnitTable::MakeAsymmetric
  /// Whether the displacements of units follow from `units` and `weights` (UnitChannels); else
  /// they are the head's own.
  bool units_by_place = false;
  std::vector<Channel> channels;

  LidRig lids;
  std::vector<BallLid> ball_lids;
  LipRig lips;
  ToothArch upper_teeth{}, lower_teeth{};
  std::vector<TeethContact> teeth_contacts;
  glm::vec3 jaw_hinge = kJawHinge;  ///< the jaw's axis goes through it along x
  std::uint32_t chin = 0;           ///< the vertex that kJawByChin looks at
  Sided<glm::vec3> eye_pivot;       ///< what the eyes turn about
  Sided<glm::vec3> ball_centre;     ///< of what `ball_lids` stay outside of
  std::optional<LookRanges> look;   ///< else eyes turn as far as the gaze does
  /// How deep each Crease is at rest, and a factor on all of them; nothing where the head shows
  /// none.
  std::optional<std::array<float, kCreases>> creases;
  float crease_depth = 1;
  std::vector<Spring> springs;
  std::vector<SpringWeight> spring_weights;  ///< of vertices of Bone::kSkull or kSkin
};

/// The channels of the units' table for vertices of skin with these weights.
std::vector<Channel> UnitChannels(const UnitTable& units, std::span<const Bone> bones,
                                  std::span<const SkinWeights> weights);

/// The same for some of the vertices, numbered as in `vertices`, which holds those that steps look
/// at (StepVertices). Normals of soft triangles are left at rest.
RigData OnlyVertices(const RigData& data, std::span<const std::uint32_t> vertices);
/// Vertices on whose places the steps found those of others: where lips meet, the chin.
std::vector<std::uint32_t> StepVertices(const RigData& data);

/// The rig of vertices that stay where they are.
RigData StillRig(std::vector<glm::vec3> position, std::vector<glm::vec3> normal);

}  // namespace fsm
