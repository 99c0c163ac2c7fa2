#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fsm/head/head.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/rig.h"

namespace fsm {

struct Pose;
class UnitTable;

/// Where the eyes of every head from elsewhere are put: those of the built-in head
/// (head/tables/eye.txt).
inline constexpr glm::vec3 kEyePlace{30.5f, 22.3f, 63.6f};

/// How far an eye turns for a gaze: in proportion up to `gaze_deg`, where it has turned by `turn`
/// (degrees; where shapes do it, the weight of one). VRM 0.x and 1.0, "lookAt".
struct LookRange {
  float gaze_deg = 90, turn = 10;
};
struct LookRanges {
  LookRange inner, outer, up, down;
};

/// Where an eye looks: to the viewer's right, and up.
struct Gaze {
  float right_deg = 0, up_deg = 0;
};
Gaze GazeOf(const glm::mat3& eye);
glm::mat3 EyeTo(const Gaze& gaze);

/// Somebody else's head at rest, in our frame and millimetres: what MeshHead shows.
struct MeshModel {
  std::string name;  ///< of its file, for messages; may be empty
  std::vector<glm::vec3> position;
  std::vector<Bone> bone;                 ///< kSkin moves as MeshMotion says
  std::vector<float> neck;                ///< part of the head's turn each vertex makes
  std::vector<glm::vec3> albedo;          ///< linear RGB
  std::vector<glm::vec3> photo_texcoord;  ///< see HeadTopology
  std::shared_ptr<const Image> photo, relief, lights;
  std::vector<PbrMaterial> finishes;
  std::vector<HeadMesh::Batch> batches;
  std::array<EyePlace, 2> eyes{};  ///< right, left; meaningful where has_eyes
  bool has_eyes = false;
  std::optional<std::array<glm::vec3, 2>> eye_pivot;  ///< what they turn about, if not the centres
  std::optional<LookRanges> look;                     ///< else they turn as ours do
  bool round_eyes = true;                             ///< balls that lids must stay outside of
  bool has_uv_seams = false;   ///< vertices are doubled where the texture is sewn together
  glm::vec3 hinge{0, -4, -3};  ///< the jaw's axis goes through it, as ours does
  Landmarks landmarks;
  /// Vertices of the upper and the lower lip that meet when the mouth is closed, from the agent's
  /// right to left.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;

  std::uint32_t Add(glm::vec3 p, Bone b, glm::vec3 colour, glm::vec3 place = {}, float turn = 1);
  void Triangle(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// The triangles of that material which take light so.
  HeadMesh::Batch& BatchOf(Material material, int finish, bool two_sided);
  /// Every triangle of flesh, three corners each.
  std::vector<std::uint32_t> SkinTriangles() const;
  std::vector<std::uint32_t> EyeTriangles() const;  ///< those of the eyeballs
  /// An eyeball with an iris about eyes[side], in our own colours.
  void AddBall(std::size_t side);
};

/// What the lower jaw does: about the hinge, forward and to the viewer's right.
struct JawMove {
  float open_rad = 0, slide_mm = 0, sway_mm = 0;
};

/// How the flesh of a MeshModel follows a state. Immutable; thread: any.
class MeshMotion {
 public:
  virtual ~MeshMotion() = default;
  /// `position`: of all vertices, at rest on entry; those of flesh are moved, the head's turn
  /// apart.
  virtual JawMove Move(const FaceState& state, const Pose& pose,
                       std::span<glm::vec3> position) const = 0;
  /// The same, where units move as another table says; nothing if that changes nothing here.
  virtual std::unique_ptr<MeshMotion> WithUnits(const UnitTable& /*units*/) const {
    return nullptr;
  }
};

/// A head that shows `model`, moved by `motion`. Throws std::runtime_error if the model has no
/// triangles.
std::unique_ptr<Head> MakeMeshHead(MeshModel model, std::unique_ptr<MeshMotion> motion);

}  // namespace fsm
