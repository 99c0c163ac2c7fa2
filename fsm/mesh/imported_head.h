#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/mesh/head_points.h"
#include "fsm/mesh/mesh_model.h"
#include "fsm/rig/face_state.h"

namespace fsm {

/// Somebody else's head as its file has it: own unit and frame, y up.
struct ImportedHead {
  struct Part {
    std::string name;  ///< of group, mesh and material (PartNames)
    std::vector<std::uint32_t> indices;
    glm::vec3 colour{0.6f, 0.42f, 0.33f};  ///< linear
    int picture = -1;                      ///< index into pictures
    bool cut_out = false;                  ///< what is transparent in the picture is left out
    bool two_sided = false;
    int pbr = -1;  ///< index into pbr_materials; -1: shown as it is
  };
  /// How the light on a picture differs from place to place: see TextureMaps::normal_map.
  struct Detail {
    Image normal_map, emissive_map;  ///< either may be empty
  };
  /// A shape of its own: what it is called there, and by how much it moves which vertices.
  struct Shape {
    struct Delta {
      std::uint32_t vertex;
      glm::vec3 by;
    };
    std::string name;
    std::vector<Delta> deltas;
  };
  std::string name;                 ///< of the file, for messages
  std::vector<glm::vec3> position;  ///< all within kMaxMeshReach
  std::vector<glm::vec2>
      texcoord;                 ///< in the part's picture, v down; of each vertex, or none at all
  std::vector<glm::vec3> tint;  ///< linear, on the part's colour; of each vertex, or none at all
  std::vector<Part> parts;
  std::vector<Image> pictures;
  std::vector<Detail> details;  ///< of the first pictures
  std::vector<PbrMaterial> pbr_materials;
  std::vector<Shape> shapes;
  std::vector<std::optional<Side>> eye;  ///< the one that a vertex is of; or none at all
  /// What those turn about, right and left, where the file says it.
  std::optional<Sided<glm::vec3>> eye_pivot;
  std::optional<GazeRanges> gaze_ranges;  ///< how the eyes follow a gaze, where the file says it
  SpringRig swing;                        ///< see VrmSprings
  bool gaze_by_shape = false;             ///< not by turning, but by shapes vrmlookleft and so on
  std::vector<std::string> notices;       ///< what was left out
  std::vector<std::string> named_files;   ///< paths of other files it names, there or not
  bool metres = false;                    ///< the file's kind says so
};

/// Reads .obj, .gltf, .glb or .vrm. Pictures and buffers beside the file are read from its folder
/// only. Errors: kUnavailable, kLimit, kBadValue naming file and place.
vm::Result<ImportedHead> ReadImportedHead(const std::string& path);
/// A file that `path` names by `name`; nothing if that leads out of its folder.
std::optional<std::string> FileBeside(const std::string& path, const std::string& name);

/// A name in small letters without anything but letters and digits; _L and _R at its end become
/// left and right, so that names of different makers are the same.
std::string PlainShapeName(std::string_view name);

}  // namespace fsm
