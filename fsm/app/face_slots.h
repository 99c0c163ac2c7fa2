#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// What moves the face: expressions, action units, mouth units, eyes, head and movements.
void DeclareFaceSlots(FsmCore& core);

/// What belongs to the whole figure: AgentEnable, AgentAlpha, AgentRot, AgentTrans, AgentScale.
void DeclareFigureSlots(FsmCore& core);

}  // namespace fsm
