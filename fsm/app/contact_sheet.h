#pragma once

#include <string>
#include <vector>

#include "fsm/app/face_library.h"
#include "fsm/app/face_view.h"
#include "fsm/motion/inputs/motion_tables.h"

namespace fsm {

/// Contact sheets: many faces in one picture.
struct ContactSheetCell {
  std::string label;
  FaceState state;
  std::string face;  ///< "" = the current face
};
struct ContactSheet {
  std::vector<ContactSheetCell> cells;
  int columns = 1;
};

/// Returns the cells of a sheet. `kind`: aus (every unit and code at full strength), emotions
/// (neutral and the six, pattern 1), visemes (the 28 mouth shapes, then the 14), identities (each
/// of `faces`: front, three-quarter, profile, smiling). Error: kBadValue listing the kinds.
vm::Result<ContactSheet> MakeSheet(const std::string& kind, const MotionTables& tables,
                                   const std::vector<std::string>& faces, const std::string& face);

inline constexpr int kCellWidth = 220, kCellHeight = 260;
/// Draws a sheet; resizes the view to that of a cell. Errors: those of view and library.
vm::Result<Image> DrawSheet(FaceView& view, FaceLibrary& library, const ContactSheet& sheet,
                            bool labels);

}  // namespace fsm
