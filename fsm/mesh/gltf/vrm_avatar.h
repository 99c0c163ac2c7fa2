#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsm/mesh/gltf/gltf_document.h"
#include "fsm/mesh/gltf/gltf_nodes.h"
#include "fsm/mesh/mesh_model.h"

namespace fsm {

/// What a file says of an avatar's face: the extensions VRM (0.x) and VRMC_vrm (1.0) in one form,
/// and of other files the bones called as eyes are.
struct VrmAvatar {
  /// A morph target and how much of it.
  struct Bind {
    std::int64_t mesh, node;  ///< node -1: wherever the mesh is
    std::int64_t target;
    double weight;
  };
  struct Expression {
    std::string name;
    std::vector<Bind> binds;
  };
  Sided<std::int64_t> eye_bone{-1, -1};  ///< nodes; -1: none
  /// Avatars of VRM 0.x look to -z, those of 1.0 and other glTF to +z.
  bool looks_back = false;
  bool says_gaze_ranges = false;  ///< `gaze_ranges` is the file's
  bool gaze_by_shape = false;     ///< gaze is a matter of expressions, not of bones
  GazeRanges gaze_ranges;
  std::vector<Expression> expressions;
};
VrmAvatar ReadVrm(const GltfDocument& document);

}  // namespace fsm
