#pragma once

#include <string>
#include <string_view>

#include "fsm/motion/motion_patterns.h"

namespace fsm {

/// Reads the original's motion file: `//` comments, the number of keys, then `ms x y z` a line.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<HeadCurve> ReadMotionFile(const std::string& name, std::string_view text);

/// Reads tables/motions.txt. Error: kBadValue "NAME:LINE: what was expected".
vm::Result<MotionPatterns> ReadMotions(const std::string& name, std::string_view text,
                                       const UnitNames& units);

}  // namespace fsm
