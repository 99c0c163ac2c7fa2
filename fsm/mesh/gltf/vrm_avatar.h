#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fsm/mesh/gltf/gltf_document.h"
#include "fsm/mesh/gltf/gltf_nodes.h"
#include "fsm/mesh/unrigged_head.h"

namespace fsm {

/// What a file says about an avatar's face: the extensions VRM (0.x) and VRMC_vrm (1.0) in one
/// form; for other glTF files, the bones with names of eyes.
struct VrmAvatar {
  /// A morph target and its weight.
  struct Bind {
    std::int64_t mesh, node;  ///< node -1: every node with the mesh
    std::int64_t target;
    double weight;
  };
  struct Expression {
    std::string name;
    std::vector<Bind> binds;
  };
  Sided<std::int64_t> eye_bone{-1, -1};  ///< nodes; -1: none
  /// Whether the avatar faces -z, as in VRM 0.x; in VRM 1.0 and other glTF it faces +z.
  bool faces_minus_z = false;
  bool gaze_by_shape = false;             ///< whether expressions, not bones, move the eyes
  std::optional<GazeRanges> gaze_ranges;  ///< none: the file has none
  std::vector<Expression> expressions;
};
VrmAvatar ReadVrm(const GltfDocument& document);

}  // namespace fsm
