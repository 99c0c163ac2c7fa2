#pragma once

#include <string>
#include <string_view>

#include "fsm/motion/motion_table.h"

namespace fsm {

/// Reads tables/motions.txt. Error: kBadValue "NAME:LINE: what was expected".
vm::Result<MotionTable> ReadMotions(const std::string& name, std::string_view text,
                                    const UnitNames& units);

}  // namespace fsm
