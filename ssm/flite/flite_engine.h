#pragma once

#include <memory>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// English speech by flite, in process: the voices slt (female), rms, awb (male, Scottish) and
/// kal16 (male, quick and plain). Phoneme names are flite's: lower-case ARPAbet, ax, pau.
/// Planning takes about 1 ms for every 200 ms of speech, all the sound about 3 ms (2 cores of
/// 2020). Thread: any; the library's voices are shared by the process, so calls take turns. Errors:
/// kUnavailable if flite gives no utterance, kStopped when cancelled.
std::unique_ptr<SpeechEngine> MakeFliteEngine();

}  // namespace ssm
