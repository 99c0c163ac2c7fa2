#pragma once

#include <string>
#include <string_view>

#include "fsm/motion/inputs/motion_patterns.h"

namespace fsm {

/// Reads a motion file of the original: `//` comments, the number of keys, then a line `ms x y z`
/// for each key.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<HeadCurve> ReadMotionFile(const std::string& name, std::string_view text);

/// Reads tables/motions.txt. Error: kBadValue "NAME:LINE: what was expected".
vm::Result<MotionPatterns> ReadMotions(const std::string& name, std::string_view text,
                                       const UnitNames& units);

}  // namespace fsm
