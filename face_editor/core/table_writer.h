#pragma once

#include <string>
#include <string_view>

#include "face_editor/core/state.h"
#include "vm_protocol/core/result.h"

namespace editor {

// Tables written back into the text they were read from: comments, blank lines and every row that
// says the same stay as they are. `text` must have been read without an error. What is given is
// what is read again, but for the sixth digit of a number.

/// mouth_shapes.txt or mouth_shapes_28.txt. REQUIRES: the same names.
std::string WriteVisemes(std::string_view text, const fsm::Visemes& shapes);
/// emotions.txt.
std::string WriteExpressions(std::string_view text, const fsm::ExpressionTable& expressions,
                             const fsm::UnitNames& names);
/// The movements of the head in motions.txt; its other lines are not touched.
std::string WriteCurves(std::string_view text, const HeadCurves& curves);

}  // namespace editor
