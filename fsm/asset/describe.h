#pragma once

#include <string>

#include "fsm/rig/head.h"

namespace fsm {

/// Describes a head for people: its parts and materials, pictures, bones, channels, steps and
/// landmarks. Ends with a line break.
std::string Describe(const Head& head);

}  // namespace fsm
