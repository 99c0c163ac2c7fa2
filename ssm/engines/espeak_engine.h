#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// Any language by espeak-ng in a helper program (ssm/espeak_helper), started at the first text,
/// kept, and started again if it dies. About 10 ms a sentence, all its sound included. Phonemes:
/// Japanese in the original's set, all others in flite's. Japanese is read by MeCab first.
/// Thread: any; calls take turns.
/// Errors: kUnavailable (no helper, no voice, it died twice), kTimeout (it is killed then).
struct EspeakOptions {
  std::string helper{};                   ///< path of ssm_espeak
  std::string dictionary{};               ///< for Japanese; empty = where Debian puts it
  std::chrono::milliseconds limit{5000};  ///< for one sentence
  std::string variant{};  ///< of all voices, as espeak-ng calls it ("f2"); empty: none
};
/// `voices`: names "espeak-LANGUAGE" for each of the table of languages.
std::unique_ptr<SpeechEngine> MakeEspeakEngine(EspeakOptions options);

}  // namespace ssm
