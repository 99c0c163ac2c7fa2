#pragma once

#include "fsm/app/options.h"

namespace fsm {

/// Carries out --export, --describe or --sheet, with the same face, tables and configuration as the
/// module. Returns whether one of them was given. Throws std::runtime_error. REQUIRES:
/// ResolveOptions has been called.
bool RunOnce(const Options& options);

}  // namespace fsm
