#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fsm/head/landmarks.h"
#include "fsm/head/mesh_builder.h"
#include "fsm/rig/head.h"

namespace fsm {

/// A head that is not built in, at rest, in the frame of HeadVertices, millimetres. RigUnriggedHead
/// converts it to a Head, in which vertices of Bone::kSkin are moved by the given rig and the
/// others by their bones.
struct UnriggedHead {
  std::string name;  ///< the file name in messages; may be empty
  MeshBuilder mesh;  ///< of its weights only SkinWeights::neck is used
  TextureMaps textures;
  std::vector<PbrMaterial> pbr_materials;
  Sided<EyeGeometry> eyes;  ///< meaningful where has_eyes, as eye_rig
  EyeRig eye_rig;
  bool has_eyes = false;
  bool round_eyes = true;           ///< eyeballs are spheres, which lids must not enter
  bool has_uv_seams = false;        ///< see TransferSurface
  glm::vec3 jaw_hinge = kJawHinge;  ///< a point on the jaw's axis, which is parallel to x
  SpringRig spring_rig;
  Landmarks landmarks;
  std::optional<ParallelView> view;  ///< the view that the file intends
  MouthVertices mouth;               ///< without incisors, which RigUnriggedHead finds

  /// Adds a vertex and returns its index. `at`: its texture coordinates; if missing, it has its own
  /// colour. `neck`: SkinWeights::neck.
  std::uint32_t Add(glm::vec3 p, Bone b, glm::vec3 colour, std::optional<glm::vec2> at = {},
                    float neck = 1);
  /// Returns the triangles of flesh, three vertex indices each.
  std::vector<std::uint32_t> FleshTriangles() const;
  std::vector<std::uint32_t> EyeTriangles() const;  ///< the same of the eyeballs
  /// Adds an eyeball with an iris about eye_rig.centre[side], in our own colours.
  void AddEyeball(Side side);
};

}  // namespace fsm
