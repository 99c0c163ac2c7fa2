#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// One sentence for flite.
struct FliteSentence {
  std::string text{};  ///< ASCII
  std::string voice{};
  double stretch = 1;
  double pitch = 1;
  /// Words of `text` with a pronunciation of their own: flite's phonemes, vowels with their stress
  /// (hh ax l ow1), blanks between.
  std::vector<std::pair<std::string, std::string>> pronunciations{};
};

/// What flite says of a sentence.
struct FliteAnalysis {
  vm::PhonemeList phonemes{};
  std::vector<WordTime> words{};
};

/// The library itself, behind a lock: its voices are variables of the process, and a voice is
/// changed by every use of it. Nothing else includes flite's headers but srm's letter-to-sound.
/// Thread: any; calls take turns.
class FliteLibrary {
 public:
  /// Called in the course of Speak, on its thread: first the analysis, once (half of the work is
  /// done then), then the sound, at least 50 ms at a time. Each returns false to end it.
  struct Listener {
    std::function<bool(FliteAnalysis)> analysed;
    std::function<bool(std::span<const std::int16_t>)> sound;
  };
  FliteLibrary();
  const std::vector<VoiceInfo>& voices() const { return infos_; }
  /// False if flite could not read the text; the listener may have been called all the same.
  static bool Speak(const FliteSentence& sentence, const Listener& listener);

 private:
  std::vector<VoiceInfo> infos_;
};

}  // namespace ssm
