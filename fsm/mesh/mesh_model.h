#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fsm/head/head_mesh.h"
#include "fsm/head/landmarks.h"
#include "fsm/rig/head.h"

namespace fsm {

/// A head from elsewhere at rest, in the frame of HeadVertices, millimetres. MakeMeshHead makes a
/// Head of it: vertices of Bone::kSkin move by the rig that it is given, the others with their
/// bones. Of the weights only `neck` is read.
struct MeshModel : HeadMesh {
  std::string name;  ///< of its file, for messages; may be empty
  TextureMaps textures;
  std::vector<PbrMaterial> pbr_materials;
  Sided<EyeGeometry> eyes;  ///< meaningful where has_eyes
  bool has_eyes = false;
  std::optional<Sided<glm::vec3>> eye_pivot;  ///< what they turn about, if not the centres
  std::optional<GazeRanges> gaze_ranges;      ///< else they turn as ours do
  bool round_eyes = true;                     ///< balls that lids must stay outside of
  bool has_uv_seams = false;    ///< vertices are doubled where the texture is sewn together
  glm::vec3 hinge = kJawHinge;  ///< the jaw's axis goes through it along x
  SpringRig swing;
  Landmarks landmarks;
  std::optional<ParallelView> view;  ///< how it is meant to be seen
  /// Vertices of the upper and the lower lip that meet when the mouth is closed, from the agent's
  /// right to left.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;

  /// `at`: where in the photo it is shown; else it has its own colour. `turn`: the part of the
  /// head's turn it makes.
  std::uint32_t Add(glm::vec3 p, Bone b, glm::vec3 colour, std::optional<glm::vec2> at = {},
                    float turn = 1);
  /// Every triangle of flesh, three corners each.
  std::vector<std::uint32_t> SkinTriangles() const;
  std::vector<std::uint32_t> EyeTriangles() const;  ///< those of the eyeballs
  /// An eyeball with an iris about eyes[side], in our own colours.
  void AddBall(Side side);
};

}  // namespace fsm
