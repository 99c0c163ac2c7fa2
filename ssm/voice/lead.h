#pragma once

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// Shortens the silence at the beginning of a plan to `most`; words and marks move with the sound,
/// and a mark before it comes at once. Returns what was cut, 0 if it was no longer. Pure.
Millis CutLead(SpeechPlan& plan, Millis most);

}  // namespace ssm
