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

/// A head that is not built in, at rest, in the frame of HeadVertices, millimetres. MakeMeshHead
/// converts it to a Head, in which vertices of Bone::kSkin are moved by the given rig and the
/// others by their bones. Of the weights only `neck` is used.
struct MeshModel : HeadMesh {
  std::string name;  ///< the file name in messages; may be empty
  TextureMaps textures;
  std::vector<PbrMaterial> pbr_materials;
  Sided<EyeGeometry> eyes;  ///< meaningful where has_eyes
  bool has_eyes = false;
  std::optional<Sided<glm::vec3>> eye_pivot;  ///< centres of rotation, if not those of `eyes`
  std::optional<GazeRanges> gaze_ranges;      ///< none: those of the built-in heads
  bool round_eyes = true;                     ///< eyeballs are spheres, which lids must not enter
  bool has_uv_seams = false;                  ///< see TransferSurface
  glm::vec3 hinge = kJawHinge;                ///< a point on the jaw's axis, which is parallel to x
  SpringRig swing;
  Landmarks landmarks;
  std::optional<ParallelView> view;  ///< the view that the file intends
  /// Pairs of vertices of upper and lower lip that meet when the mouth is closed, from the agent's
  /// right to left.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;

  /// Adds a vertex and returns its index. `at`: its texture coordinates; if missing, it has its own
  /// colour. `turn`: the weight with which it follows the head's rotation.
  std::uint32_t Add(glm::vec3 p, Bone b, glm::vec3 colour, std::optional<glm::vec2> at = {},
                    float turn = 1);
  /// Returns the triangles of flesh, three vertex indices each.
  std::vector<std::uint32_t> SkinTriangles() const;
  std::vector<std::uint32_t> EyeTriangles() const;  ///< the same of the eyeballs
  /// Adds an eyeball with an iris about eyes[side], in our own colours.
  void AddBall(Side side);
};

}  // namespace fsm
