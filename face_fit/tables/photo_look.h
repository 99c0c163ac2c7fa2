#pragma once

#include "embedded/photo_look_numbers.h"
#include "fsm/base/number_table.h"

namespace facefit {

/// Returns the numbers of tables/photo_look.txt, where each is explained. The table is part of the
/// program and no user replaces it, so these are constants, not a state that would have to be
/// passed. Throws std::runtime_error that names the line if a number is beyond the limits of its
/// row. Thread: any.
const PhotoLookNumbers& PhotoLook();

}  // namespace facefit
