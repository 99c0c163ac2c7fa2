#pragma once

#include "embedded/photo_look_numbers.h"
#include "fsm/base/number_table.h"  // SmoothStep, for rows that are ranges

namespace facefit {

/// Returns the numbers of tables/photo_look.txt, where each is explained. The table is part of the
/// program and no user replaces it, so these are constants, not a state that would have to be
/// passed. Thread: any.
const PhotoLookNumbers& PhotoLook();

/// Returns the numbers of a table of that kind. Throws std::runtime_error that names the row if a
/// least value exceeds the greatest one that belongs to it.
PhotoLookNumbers CheckedPhotoLook(const fsm::NumberTable& table);

}  // namespace facefit
