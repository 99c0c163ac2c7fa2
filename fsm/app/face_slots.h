#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Declares the slots that move the face: expressions, action units, mouth units, eyes, head,
/// movements and what it does by itself. Lifetime: `core` outlives the slots.
void DeclareFaceSlots(FsmCore& core);

/// Declares what belongs to the whole figure: AgentEnable, AgentAlpha, AgentRot, AgentTrans,
/// AgentScale.
void DeclareFigureSlots(FsmCore& core);

}  // namespace fsm
