#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Declares the slots of the drawing style, springs, camera and lamps, and SaveImage.
void DeclareSceneSlots(FsmCore& core);

/// Restores the initial scene, with the original's measures and colours if FsmCore::conventions
/// asks for them, and the springs.
void ResetScene(FsmCore& core);

}  // namespace fsm
