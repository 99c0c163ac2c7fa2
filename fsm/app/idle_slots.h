#pragma once

#include <string>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Declares the slots of idle behaviour: Autonomous (each kind by name), Life (profiles of kinds),
/// Gaze and Gaze.distance. `life`: the initial profile.
void DeclareIdleSlots(FsmCore& core, const std::string& life);

}  // namespace fsm
