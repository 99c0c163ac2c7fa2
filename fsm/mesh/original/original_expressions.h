#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fsm/mesh/original/original_face.h"
#include "fsm/rig/face_state.h"

namespace fsm {

/// The original has whole expressions as files of offsets, AU31.pnt to AU36.pnt and those of users;
/// here an expression is a set of action units. Each file is decomposed (NnlsSolver) into units of
/// the agent's right and left side and a residual, which is shown with them.

struct OriginalExpression {
  std::string name;                                    ///< as in the slot FaceExp
  int pattern = 1;                                     ///< counted from 1
  Sided<std::array<float, kOriginalUnits>> strengths;  ///< indexed as kUnitNumbers
  std::optional<std::size_t> residual;  ///< index into Residuals; none: it is not shown
};

struct OriginalExpressions {
  std::vector<OriginalExpression> expressions;
  /// At most as many as Residuals has; offsets in the unit of the files.
  std::vector<PntFile> residuals;
  /// Expressions for whose residual no number was left; only their units are shown.
  std::vector<std::string> without_residual;
};

/// Reads the expressions of a folder that contains _AU_Datas; skips missing files. `standard`: the
/// wireframe that the offsets belong to. Errors: as ReadOriginalFace.
vm::Result<OriginalExpressions> ReadOriginalExpressions(const std::string& folder,
                                                        const std::string& standard);

}  // namespace fsm
