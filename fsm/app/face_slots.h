#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Declares the slots that move the face: expressions, action units, mouth units, eyes, head and
/// movements.
void DeclareFaceSlots(FsmCore& core);

/// Declares the slots of the whole figure: AgentEnable, AgentAlpha, AgentRot, AgentTrans,
/// AgentScale.
void DeclareFigureSlots(FsmCore& core);

}  // namespace fsm
