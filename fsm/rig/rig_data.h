#pragma once

#include <array>
#include <cstddef>
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
/// Each works on the result of the steps before it. All of them rely on the arrays of RigData that
/// are per vertex; what a step relies on beside these stands after "Needs". CheckAsset checks all
/// of it in a head that comes from a file.
///
/// A new step is
/// - here an enumerator, and in RigData what it knows; if that names vertices, also in
/// OnlyVertices;
/// - in steps.glsl what becomes of one vertex, once for the processor and graphics cards;
/// - in rig_steps.cc its name (NameOf) and a case of Take, which goes through the vertices;
/// - for graphics cards STEP_name in fsm/render/shaders/rig_kernels.glsl, which goes through them
///   there, and a case of RecordsOfSteps; render_gpu_rig_test.cc compares both;
/// - what it needs in CheckAsset; its members in asset_members.h; the last enumerator in kValuesOf.
enum class RigStep : std::uint8_t {
  // These shape the skin of a head that looks ahead. They write positions only.
  /// Units and mouth parameters displace vertices. Needs: the number of each Drive is one that its
  /// kind has; Channel::least is not above Channel::most; moves name vertices.
  kChannels,
  kLids,         ///< lids turn about the eyes, over the cornea. Needs: `lids` names vertices
  kLidsOnBalls,  ///< what was outside an eyeball stays outside. Needs: `ball_lids` names vertices
  kJaw,          ///< skin goes with the jaw, by its weights
  /// The jaw opens and sways as far as JawRig::chin has gone. Needs: that is a vertex.
  kJawByChin,
  kTeeth,  ///< lips are held off the teeth. Needs: TeethRig::contacts names vertices
  /// Lips that would cross meet, and close as far as they are sealed. Needs: the seam and the
  /// followers name vertices, each follower a pair of the seam; apart_at_rest is empty or has one
  /// element for each pair.
  kLips,
  kOwnForm,  ///< vertices go by ProxyForm::to_own. Needs: it is empty or per vertex

  // These write normals, too, but for kSprings.
  kTongue,  ///< the tongue finds its way between teeth and lips. Needs: the seam names vertices
  kBones,   ///< jaw and eyes turn, with what is fixed to them
  kNeck,    ///< the head turns and goes forward
  /// What is soft swings, where a simulation says how far. Needs: the weights of SpringRig name
  /// vertices and springs; the simulation is of the same springs.
  kSprings,
  /// Normals are found from the moved skin. Needs: soft_triangles are three vertices each; twin is
  /// empty, or per vertex and names vertices.
  kNormals
};

/// Whether a step shapes the skin, rather than what comes after: tongue, bones, neck and normals.
constexpr bool ShapesSkin(RigStep step) { return step < RigStep::kTongue; }

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
  /// First those that shape the skin (ShapesSkin), in any order, also several times. Then the
  /// others in the order of RigStep, each at most once. At most kMostSteps.
  std::vector<RigStep> steps;
  static constexpr std::size_t kMostSteps = 32;
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
RigData MakeStillRig(std::vector<glm::vec3> position, std::vector<glm::vec3> normal);

}  // namespace fsm
