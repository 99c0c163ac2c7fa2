#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "fsm/base/enum_names.h"
#include "fsm/rig/channel.h"
#include "fsm/rig/lid_rig.h"
#include "fsm/rig/lip_rig.h"
#include "fsm/rig/normals.h"
#include "fsm/rig/skin_weights.h"
#include "fsm/rig/spring.h"
#include "fsm/rig/teeth_rig.h"
#include "fsm/rig/unit_table.h"

namespace fsm {

/// The hinge of the built-in heads' jaw: a point on an axis along x.
inline constexpr glm::vec3 kJawHinge{0, -4, -3};
/// The point in the upper neck that the head turns about.
inline constexpr glm::vec3 kNeckPivot{0, -85, -28};

/// An eye's rotation grows linearly with the gaze up to `gaze_deg`, where it is `output` (degrees;
/// the weight of a blend shape where shapes move the eyes). VRM 0.x and 1.0, "lookAt".
struct GazeRange {
  float gaze_deg = 90, output = 10;
};
struct GazeRanges {
  GazeRange inner, outer, up, down;
};

/// The steps that compute vertices from a state; RigData::steps lists those of a head in order.
/// Each step works on the result of the steps before it. All of them read the arrays of RigData
/// that are per vertex; "Needs" names what a step reads beside these. CheckRig checks these needs
/// in a head that comes from a file.
///
/// docs/extending.md tells how to add a step.
enum class RigStep : std::uint8_t {
  // These steps shape the skin of a head that looks ahead. They write positions only.
  /// Action units and mouth parameters displace vertices. Needs: the number of each Drive is valid
  /// for its kind; Channel::min is not above Channel::max; moves name vertices.
  kChannels,
  kLids,         ///< lids rotate about the eyes, over the cornea. Needs: `lids` names vertices
  kLidsOnBalls,  ///< lid skin stays outside the eyeballs. Needs: `ball_lids` names vertices
  kJaw,          ///< skin follows the jaw by its weights
  /// The jaw opens and sways as far as JawRig::chin has moved. Needs: `chin` is a vertex.
  kJawByChin,
  kTeeth,  ///< lips are pushed off the teeth. Needs: TeethRig::contacts names vertices
  /// Lips that would cross meet instead, and sealed lips close. Needs: followers name vertices and
  /// pairs of the seam; apart_at_rest is empty or has one element for each pair.
  kLips,
  kOwnForm,  ///< adds ProxyForm::to_own. Needs: it is empty or per vertex

  // These steps write normals as well, except kSprings.
  kTongue,  ///< the tongue passes between teeth and lips
  kBones,   ///< jaw and eyes rotate, with all that is fixed to them
  kNeck,    ///< the head turns and goes forward
  /// Soft parts swing by the offsets of a simulation. Needs: the weights of SpringRig name vertices
  /// and springs; the simulation was made from the same springs.
  kSprings,
  /// Normals are computed from the moved skin. Needs: soft_triangles has three vertices for each
  /// triangle; twin is empty, or per vertex and names vertices.
  kNormals
};

inline constexpr std::size_t kRigSteps = kValuesOf<RigStep>;
inline constexpr auto kSkinSteps = static_cast<std::size_t>(RigStep::kTongue);

/// Tells whether a step shapes the skin; the others move tongue, bones, neck and normals.
constexpr bool ShapesSkin(RigStep step) { return static_cast<std::size_t>(step) < kSkinSteps; }

/// The jaw, which rotates about an axis through `hinge` along x.
struct JawRig {
  glm::vec3 hinge = kJawHinge;
  std::uint32_t chin = 0;  ///< the vertex that kJawByChin measures
};

/// How the eyes rotate.
struct EyeRig {
  Sided<glm::vec3> centre;                ///< of the eyeballs
  std::optional<Sided<glm::vec3>> pivot;  ///< what they rotate about; none: `centre`
  std::optional<GazeRanges> gaze_ranges;  ///< none: the eyes rotate by the gaze angles
};

/// The other head that a transferred rig was taken from (its proxy). Both arrays are per vertex,
/// and empty where the rig is the head's own.
struct ProxyForm {
  /// Rest position on the proxy, which the steps before kOwnForm start from.
  std::vector<glm::vec3> rest;
  /// Offset from the proxy's neutral position to this head's rest position.
  std::vector<glm::vec3> to_own;
};

/// How the skin creases; arrays are in the order of Crease.
struct CreaseRig {
  std::optional<std::array<float, kLastingCreases>> at_rest;  ///< none: creases are not shown
  float depth = 1;                                            ///< factor on all depths
};

/// How a head moves: plain data, in the frame of HeadVertices. Members that all steps read come
/// first, then those of single steps.
struct RigData {
  /// First the steps that shape the skin (ShapesSkin), in any order and any number of times; then
  /// the others in the order of RigStep, each at most once. At most kMaxSteps.
  std::vector<RigStep> steps;
  static constexpr std::size_t kMaxSteps = 32;
  std::vector<glm::vec3> rest, rest_normal;  ///< per vertex
  std::vector<Bone> bone;                    ///< per vertex
  std::vector<SkinWeights> weights;          ///< per vertex
  MouthVertices mouth;
  UnitTable units;                    ///< what each action unit does, and how units combine
  std::optional<int> asymmetry_seed;  ///< for UnitCombiner; none: both sides alike
  /// Whether UnitChannels computes the displacements of the action units from `units` and
  /// `weights`; otherwise they are the head's own.
  bool has_unit_channels = false;
  CreaseRig creases;

  std::vector<Channel> channels;
  LidRig lids;
  std::vector<BallLid> ball_lids;
  JawRig jaw;
  TeethRig teeth;
  LipRig lips;
  ProxyForm proxy;
  EyeRig eyes;
  SpringRig spring_rig;
  NormalRig normals;

  /// Returns the positions that the steps start from.
  const std::vector<glm::vec3>& StartPositions() const {
    return proxy.rest.empty() ? rest : proxy.rest;
  }
};

/// Returns the rig of some of the vertices, in the order of `vertices`, which must include
/// StepVertices. No normals are computed (NormalRig is empty).
RigData OnlyVertices(const RigData& data, std::span<const std::uint32_t> vertices);
/// Returns the vertices from which steps derive the positions of others, or by which
/// the mouth is measured: the lip seam, its corners and the chin.
std::vector<std::uint32_t> StepVertices(const RigData& data);

}  // namespace fsm
