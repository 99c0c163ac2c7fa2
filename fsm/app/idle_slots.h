#pragma once

#include <string>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// What makes the face alive: Autonomous (each part by name), Life (a profile of them), Gaze and
/// Gaze.distance.
/// `life`: the profile at the start.
void DeclareIdleSlots(FsmCore& core, const std::string& life);

}  // namespace fsm
