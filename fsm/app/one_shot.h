#pragma once

#include "fsm/app/options.h"

namespace fsm {

/// Does what --export, --describe or --sheet ask for, all of the face, the tables and the
/// configuration that the module would have. Returns whether one of them was given. Throws
/// std::runtime_error with a sentence. REQUIRES: Complete has been called.
bool RunOnce(const Options& options);

}  // namespace fsm
