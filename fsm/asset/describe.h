#pragma once

#include <string>

#include "fsm/rig/head.h"

namespace fsm {

/// A head in words and numbers, for people: its parts and what they are made of, pictures, bones,
/// channels, the steps that move it, landmarks and what it takes in memory. Ends with a line break.
std::string Describe(const Head& head);

}  // namespace fsm
