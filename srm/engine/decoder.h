#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ear/grammar/grammar.h"

namespace srm {

using Millis = std::chrono::milliseconds;
inline constexpr std::int64_t kSampleRateHz = 16000;
inline constexpr std::size_t kFramesPerMs = kSampleRateHz / 1000;

/// A word with its times, counted from the beginning of the utterance.
struct HeardWord {
  std::string text{};
  Millis start{0};
  Millis end{0};
  double confidence = 1;  ///< 0 to 1, of its own sound
};

/// What else an utterance may be.
struct Alternative {
  std::string text{};
  double confidence = 0;
};

/// What an utterance is taken to be.
struct Hypothesis {
  std::string text{};  ///< words with blanks between; empty = nothing fits
  std::vector<HeardWord> words{};
  /// How much worse than free phonemes the grammar fits, per 10 ms frame of speech, in the engine's
  /// units, with an allowance for noise and length; mostly above kFitThreshold where it is right.
  double fit = 0;
  double confidence = 0;              ///< 0 to 1, from `fit`; 0.5 at the threshold
  std::vector<Alternative> others{};  ///< next best first; only if they were asked for
};

/// Turns sound into words, one utterance after the other. 16 kHz, 16 bit, mono.
/// Thread: one. Errors: kUnavailable (the engine or its model), kBadValue (a grammar it cannot
/// take).
class SpeechDecoder {
 public:
  virtual ~SpeechDecoder() = default;
  /// What may be said from the next utterance on: the grammars together. Empty = the language
  /// model (dictation). Between utterances only.
  virtual vm::Result<void> Use(const std::vector<const ear::Grammar*>& grammars) = 0;
  /// A word's pronunciation, in kana or in phonemes of the model (G AE L AH T).
  virtual vm::Result<void> Pronounce(const std::string& word, const std::string& spoken) = 0;
  virtual void Begin() = 0;
  virtual void Feed(std::span<const std::int16_t> samples) = 0;
  /// The words so far; may change.
  virtual std::string Partial() = 0;
  /// What fits badly is looked at once more, which takes as long again as all of Feed did.
  virtual Hypothesis End() = 0;
  /// Ends an utterance whose result nobody wants.
  virtual void Abandon() { static_cast<void>(End()); }
  /// How many hypotheses End looks for; 1 = the best alone (the others take some ms). At most
  /// kMostAlternatives.
  virtual void set_most(std::size_t most) = 0;
};
inline constexpr std::size_t kMostAlternatives = 10;

inline constexpr double kFitThreshold = -12;
double ConfidenceOf(double fit);

/// Hears single phrases in all that is said ("stop"), for interruptions.
class KeywordSpotter {
 public:
  virtual ~KeywordSpotter() = default;
  virtual vm::Result<void> Use(const std::vector<std::string>& phrases) = 0;
  /// The phrase heard in the sound so far, once; else empty.
  virtual std::string Feed(std::span<const std::int16_t> samples) = 0;
};

struct PocketsphinxOptions {
  std::string model = "/usr/share/pocketsphinx/model/en-us";  ///< folder with en-us/ and the dict
  bool rejection = true;  ///< a second decoder of free phonemes measures the fit
};
/// The packaged English model. Words that are not in its dictionary get a pronunciation: kana by
/// table, numbers by their words, all others by letter-to-sound rules (flite's).
vm::Result<std::unique_ptr<SpeechDecoder>> OpenPocketsphinx(const PocketsphinxOptions& options);
vm::Result<std::unique_ptr<KeywordSpotter>> OpenSpotter(const PocketsphinxOptions& options);

}  // namespace srm
