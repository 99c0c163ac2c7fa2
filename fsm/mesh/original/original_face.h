// Faces of the original, the face module of the first Galatea toolkit (docs/architecture.md).

#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/mesh/obj/obj_file.h"
#include "fsm/mesh/original/original_files.h"
#include "fsm/mesh/original/pnt_file.h"
#include "fsm/mesh/unrigged_head.h"
#include "fsm/rig/face_state.h"

namespace fsm {

/// The placement of the eyeballs, from a .def_e file: 29 little-endian doubles; for the right and
/// the left eye position, rotation and scale, then the same three within the ball, and finally the
/// scale of the picture on the balls. The original draws with the first position and scale, the
/// second rotation and the picture's scale. The other numbers are remnants of its editor, some of
/// them uninitialised, and are ignored.
struct EyeDef {
  struct Eye {
    glm::vec3 position{0}, rotation_degrees{0};
    float scale = 1;
  };
  Sided<Eye> eye;
  float picture_scale = 1;
};
vm::Result<EyeDef> ParseEyeDef(const std::string& name, std::string_view bytes);
/// Parses the colour of the teeth, a .def_t file: three numbers 0..1.
vm::Result<glm::vec3> ParseTeethDef(const std::string& name, std::string_view text);

inline constexpr std::size_t kOriginalUnits = 30;
/// FACS numbers of the original's units, in its order (its manual's list; action_unit_list.txt).
inline constexpr std::array<int, kOriginalUnits> kUnitNumbers{
    1,  2,  4,  5,  6,  7,  9,  10, 11, 12, 13, 14, 15, 16, 17,
    18, 20, 22, 23, 24, 25, 26, 27, 28, 29, 30, 35, 41, 42, 43};
inline constexpr std::size_t kOriginalVisemes = 27;

/// The contents of the files of a face of the original.
struct OriginalFace {
  std::string name;
  PntFile wireframe, standard;
  LnkFile link;
  Image picture;
  std::optional<Image> eye_picture;
  std::optional<EyeDef> eye_def;
  glm::vec3 teeth{0.8f};
  glm::vec3 mouth{0.25f, 0.07f, 0.06f};
  std::optional<ObjFile> upper_teeth, lower_teeth, eye;
  /// Offsets at full strength in the wireframe's unit, indexed by its vertices.
  std::vector<std::vector<glm::vec3>> units, mouth_units, visemes;
  std::vector<std::vector<glm::vec3>> expression_residuals;  ///< see OriginalExpressions
};
/// Error: kBadValue naming the file, and the line or byte where there is one. A file whose name is
/// "" is skipped; wireframe, picture, standard, link and offsets are required.
vm::Result<OriginalFace> ReadOriginalFace(const OriginalFaceFiles& files,
                                          const OriginalSharedFiles& shared);

}  // namespace fsm
