#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

// Groups of slots that need nothing but the core, which outlives them.

/// What moves the face: expressions, action units, mouth units, eyes, head and movements.
void DeclareFaceSlots(FsmCore& core);

/// What belongs to the whole figure: AgentEnable, AgentAlpha, AgentRot, AgentTrans, AgentScale.
void DeclareFigureSlots(FsmCore& core);

/// FaceExp.NAME.PATTERN, what each expression looks like: asked, set, saved. `def FaceExp.NAME =
/// LOOK` (pattern 1) and `def FaceExp.NAME.PATTERN = LOOK` make new ones, `del FaceExp.NAME` takes
/// an own one away and brings a changed one back. `Run = INIT` forgets them. At most 200 own names
/// between two of these.
void DeclareExpressionSlots(FsmCore& core);

/// What makes the face alive: Autonomous (each part by name), Life (a profile of them), Gaze and
/// Gaze.distance.
void DeclareIdleSlots(FsmCore& core);

/// How lips are moved: LipSync.mode, LipSync.shapes, LipSync.names, LipSync.scale, and the mouth
/// shapes themselves (MouthShape.NAME of the 14, MouthShape28.NAME of the 28), which can be set,
/// asked, saved and loaded. All act from the next utterance on.
void DeclareLipSlots(FsmCore& core);

/// MouthFrame and MouthFrame.start: the mouth frame by frame from another program (vdm).
void DeclareMouthStreamSlots(FsmCore& core);

}  // namespace fsm
