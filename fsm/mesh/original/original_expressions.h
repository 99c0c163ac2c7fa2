#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fsm/mesh/original/original_face.h"
#include "fsm/rig/face_state.h"

namespace fsm {

/// Whole expressions are files of offsets in the original, AU31.pnt to AU36.pnt and those of users,
/// but action units here. Each file is taken apart into units of the agent's right and left side;
/// what they leave is kept, as a residual, and shown with it.
///
/// An expression comes to the face as a look of FaceState::au alone, so the strength of a residual
/// is one of kResidualUnits there, on one side.
struct ResidualChannel {
  std::size_t unit;
  Side side;
};
inline constexpr std::size_t kResidualChannels = 2 * kResidualUnits.size();
/// REQUIRES: `channel` < kResidualChannels.
constexpr ResidualChannel ResidualChannelOf(std::size_t channel) {
  return {kResidualUnits[channel / 2], kSides[channel % 2]};
}

struct OriginalExpression {
  std::string name;                                    ///< of FaceExp
  int pattern = 1;                                     ///< from 1
  Sided<std::array<float, kOriginalUnits>> strengths;  ///< by the original's list of units
  std::optional<std::size_t> channel;                  ///< of its residual; none: not shown
};

struct OriginalExpressions {
  std::vector<OriginalExpression> all;
  std::vector<PntFile>
      residuals;  ///< by channel, at most kResidualChannels; offsets as the files have them
  /// Expressions whose residual found no channel left: their units alone are shown.
  std::vector<std::string> without_residual;
};

/// Reads those of the folder that holds _AU_Datas; a file that is not there is passed over.
/// `standard`: the wireframe they belong to. Errors: as ReadOriginalFace.
vm::Result<OriginalExpressions> ReadOriginalExpressions(const std::string& folder,
                                                        const std::string& standard);

/// How much a vertex `x_mm` to the viewer's right of the mouth's middle goes with units of the
/// agent's left side.
float LeftPartAt(float x_mm);

}  // namespace fsm
