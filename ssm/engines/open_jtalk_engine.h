#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "ssm/engines/piece_engine.h"

namespace ssm {

/// A Japanese voice file spoken by the program open_jtalk, one run for each sentence (0.1 s for a
/// short one). Its phoneme names are the original's already. Words come from its own analysis.
/// Errors: kUnavailable (no program, it fails), kTimeout (it is killed), kBadValue (its trace).
struct OpenJtalkOptions {
  std::string name{};  ///< the speaker's
  bool female = true;
  std::string program = "open_jtalk";
  std::string voice_file{};  ///< .htsvoice
  std::string dictionary = "/var/lib/mecab/dic/open-jtalk/naist-jdic";
  std::chrono::milliseconds limit{20'000};  ///< for one sentence
};
/// Errors: kUnavailable or kBadValue with the file's name, if the voice file or the dictionary is
/// missing or no voice.
vm::Result<std::unique_ptr<SpeechEngine>> MakeOpenJtalkEngine(OpenJtalkOptions options);

/// Reads the trace open_jtalk writes with -ot: phonemes in whole ms (of running sums, so that
/// nothing is lost by rounding) and the words of its analysis. Errors: kBadValue with the line.
vm::Result<Piece> ParseOpenJtalkTrace(std::string_view trace);

}  // namespace ssm
