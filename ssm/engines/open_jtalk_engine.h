#pragma once

#include <memory>

#include "ssm/engines/open_jtalk_program.h"
#include "ssm/engines/piece_engine.h"

namespace ssm {

/// A Japanese voice file spoken by the program open_jtalk, one run for each sentence (0.1 s for a
/// short one). Its phoneme names are the original's already. Words come from its own analysis.
/// Errors: kUnavailable (no program, it fails), kTimeout (it is killed), kBadValue (its trace).
/// This function's: kUnavailable or kBadValue with the file's name, if the voice file or the
/// dictionary is missing or no voice.
vm::Result<std::unique_ptr<SpeechEngine>> MakeOpenJtalkEngine(OpenJtalkOptions options);

}  // namespace ssm
