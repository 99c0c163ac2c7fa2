#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/base/face_look.h"
#include "fsm/motion/base/unit_list.h"

namespace fsm {

/// An expression: what its patterns look like, and how fast it appears.
struct Expression {
  std::vector<FaceLook> patterns;  ///< at full strength; pattern 1 is patterns[0]
  /// Per pattern, the strength of the expression above which a unit takes part, 0..0.9: a slight
  /// smile keeps the mouth closed.
  std::vector<FaceLook> begins;
  /// Per pattern, the power (below 1) with which a unit grows from where it begins: the eyes take
  /// part in a slight smile; 0: in proportion.
  std::vector<FaceLook> early;
  /// How an expression appears: the time from neutral to the peak, and the delay with which each
  /// region of the face begins.
  struct Timing {
    double onset_ms = 450;
    std::array<double, kRegions> lag_ms{0, 8, 14};
  };
  Timing posed;     ///< of an expression shown deliberately
  Timing elicited;  ///< of a spontaneous expression

  /// Returns the action units of a pattern at a strength. REQUIRES: the pattern exists.
  FaceLook LookOf(int pattern, double strength) const;
  /// Adds or changes a pattern; all its units grow in proportion to the strength. REQUIRES:
  /// `pattern` is 1 or more.
  void Redefine(std::size_t pattern, const FaceLook& look);
};
using ExpressionTable = std::map<std::string, Expression, std::less<>>;
/// The action units of expressions, by name and pattern number as in the slot FaceExp.
using ExpressionLooks = std::map<std::string, std::map<int, FaceLook>>;

/// Reads tables/emotions.txt. The patterns of an expression must be numbered from 1 without gaps.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<ExpressionTable> ReadExpressions(const std::string& name, std::string_view text,
                                            const UnitNames& names);

}  // namespace fsm
