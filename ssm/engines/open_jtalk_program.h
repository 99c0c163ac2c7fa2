#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// The program open_jtalk: how it is called, and what it writes of its analysis.
struct OpenJtalkOptions {
  std::string name{};  ///< the speaker's
  bool female = true;
  std::string program = "open_jtalk";
  std::string voice_file{};  ///< .htsvoice
  std::string dictionary = "/var/lib/mecab/dic/open-jtalk/naist-jdic";
  std::chrono::milliseconds limit{20'000};  ///< for one sentence
};

/// What is found in a sentence.
struct OpenJtalkAnalysis {
  struct Word {
    std::string text{};
    std::size_t phonemes = 0;
  };
  std::vector<Word> words{};
  std::vector<std::string> labels{};  ///< full context, one for each phoneme
  std::vector<Millis> ends{};         ///< beside labels, of running sums: no rounding adds up
};

/// Errors: kUnavailable with the folder's name, if there is no dictionary.
vm::Result<void> CheckOpenJtalkDictionary(const OpenJtalkOptions& options);

/// Has it read `text` (line ends become blanks, for it reads one line), with more arguments.
/// Errors: kUnavailable (no program, it fails), kTimeout (it is killed), kStopped, kBadValue (its
/// trace).
vm::Result<OpenJtalkAnalysis> RunOpenJtalk(const OpenJtalkOptions& options, std::string text,
                                           const std::vector<std::string>& arguments,
                                           const std::atomic<bool>& cancelled);

/// Reads the trace it writes with -ot. Errors: kBadValue with the line.
vm::Result<OpenJtalkAnalysis> ParseOpenJtalkTrace(std::string_view trace);

/// The phonemes of the labels, with `ends` instead of the analysis's own times. Its names are the
/// original's. What has no length is left out. REQUIRES: an end for each label.
vm::PhonemeList PhonemesOf(const OpenJtalkAnalysis& analysis, const std::vector<Millis>& ends);

/// The words over those phonemes; gives up where their counts do not agree any more.
std::vector<WordTime> WordsOf(const OpenJtalkAnalysis& analysis, const vm::PhonemeList& phonemes);

/// An argument of a program.
std::string NumberText(double value);

}  // namespace ssm
