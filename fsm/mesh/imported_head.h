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
#include "fsm/mesh/unrigged_head.h"
#include "fsm/rig/face_state.h"

namespace fsm {

/// A head as read from a file, in the file's unit and frame; y points up.
struct ImportedHead {
  struct Part {
    std::string name;  ///< the names of group, mesh and material, joined (PartNames)
    std::vector<std::uint32_t> indices;
    glm::vec3 colour{0.6f, 0.42f, 0.33f};  ///< linear
    int base_colour = -1;                  ///< index into base_colours
    bool cut_out = false;                  ///< transparent texels are not drawn
    bool two_sided = false;
    int pbr = -1;  ///< index into pbr_materials; -1: unlit
  };
  /// The textures that belong to a base colour; see TextureMaps::normal_roughness_metal.
  struct Detail {
    Image normal_roughness_metal, emission_openness;  ///< either may be empty
  };
  /// A blend shape of the file: its name there, and the displacements of vertices at weight 1.
  struct Shape {
    std::string name;
    std::vector<Displacement> moves;
  };
  std::string name;                 ///< the file name in messages
  std::vector<glm::vec3> position;  ///< all within kMaxReach
  /// In the part's textures, v down, finite; per vertex, or empty.
  std::vector<glm::vec2> texcoord;
  /// Linear, factor on the part's colour; per vertex, or empty.
  std::vector<glm::vec3> vertex_colour;
  std::vector<Part> parts;
  std::vector<Image> base_colours;
  /// Detail i belongs to base colour i; may be shorter than `base_colours`.
  std::vector<Detail> details;
  std::vector<PbrMaterial> pbr_materials;
  std::vector<Shape> shapes;
  std::vector<std::optional<Side>> eye;  ///< the eye that a vertex belongs to; per vertex, or empty
  EyeRig eye_rig;                        ///< without centres, which AlignImportedHead finds
  SpringRig spring_rig;                  ///< see VrmSprings
  bool gaze_by_shape = false;  ///< shapes (vrmlookleft ...) move the eyes, which do not rotate
  std::vector<std::string> notices;      ///< sentences about what was left out
  std::vector<std::string> named_files;  ///< paths of files that it refers to, existing or not
};

/// Reads .obj, .gltf, .glb or .vrm. Pictures and buffers that the file names are read from its
/// folder only. Errors: kUnavailable, kLimit, kBadValue naming file and place.
vm::Result<ImportedHead> ReadImportedHead(const std::string& path);
/// Returns the path of a file that the file `path` refers to as `name`; nothing if that is outside
/// its folder.
std::optional<std::string> FileBeside(const std::string& path, const std::string& name);

/// Normalises a shape name, so that those of different tools agree: lower case, letters and digits
/// only; _L and _R at the end become left and right.
std::string PlainShapeName(std::string_view name);

}  // namespace fsm
