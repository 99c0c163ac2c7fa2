#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ssm/voice/speech_engine.h"
#include "ssm/voice/utterance.h"

namespace ssm {

/// How a text was said, or shall be: durations, intonation, loudness. In a file (SavePros) as the
/// original wrote it:
///     input_text: TEXT            spoken_text: TEXT
///     number_of_phonemes: N       total_duration: MS
///     -----                       then NAME [MS] for each phoneme, and -----
///     total_frame: N              -----
///     0: F0 POWER                 one line every 5 ms, N + 1 of them, and -----
/// F0 is the natural logarithm of Hz, 0 where there is no voice. POWER is the natural logarithm of
/// the sound's rms in units of a sample (the original's was its filter's gain; of a file from it
/// only the differences count).
struct Prosody {
  std::string text{};
  std::string spoken_text{};
  vm::PhonemeList phonemes{};
  std::vector<double> f0{};
  std::vector<double> power{};
};

/// REQUIRES: the samples are complete.
Prosody ProsodyOf(const Utterance& utterance);
/// Error: kUnavailable.
vm::Result<void> WriteProsody(const Prosody& prosody, const std::string& path);
/// Errors: kUnavailable, kBadValue with the line.
vm::Result<Prosody> ReadProsody(const std::string& path);

/// The engine's plan with the file's durations. Error: kBadValue if the phonemes are others.
vm::Result<SpeechPlan> Retimed(const SpeechPlan& plan, const Prosody& prosody);
/// The engine's sound of `plan` as the prosody wants it: pitch-synchronous overlap and add (E.
/// Moulines, F. Charpentier, Speech Communication 9, 1990). Intonation more than an octave from the
/// engine's own is taken to that. `samples` has the length of the prosody's phonemes.
void Reshape(const std::vector<std::int16_t>& sound, const SpeechPlan& plan, const Prosody& prosody,
             SampleBuffer& samples);

}  // namespace ssm
