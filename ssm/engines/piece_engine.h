#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// A sentence made into sound, with everything known of it. 16 kHz mono.
struct Piece {
  vm::PhonemeList phonemes{};
  std::vector<WordTime> words{};
  std::vector<std::int16_t> samples{};
  /// Makes the samples when they are wanted, instead of `samples`; may be empty. Called once or not
  /// at all, from any thread, while the engine lives.
  std::function<vm::Result<std::vector<std::int16_t>>()> later{};
  std::string unspoken{};
};

/// An engine that speaks sentence by sentence. One that gives phonemes and sound together (another
/// program, a recording) makes the sound while planning, and rendering hands it over; one that has
/// the phonemes sooner makes it sentence by sentence while rendering. What derives from it says
/// only how one sentence is spoken.
class PieceEngine : public SpeechEngine {
 public:
  vm::Result<SpeechPlan> Plan(const std::vector<SpeechSpan>& spans,
                              const std::atomic<bool>& cancelled) final;
  vm::Result<void> Render(const SpeechPlan& plan, SampleBuffer& samples) final;
  bool Prompt(const std::vector<SpeechSpan>&) const final { return false; }

 protected:
  /// True if Speak understands words with a pronunciation of their own (pronounced_text.h); else it
  /// gets them as they are written.
  virtual bool TakesPronunciations() const { return false; }
  /// True for an emotion the engine has a voice for; its manner is then taken out of the span.
  virtual bool Expresses(const std::string&) const { return false; }
  /// `span.text` is one sentence, not blank; volume is seen to by the caller. Phonemes and sound
  /// need not have the very same length: the phonemes count.
  virtual vm::Result<Piece> Speak(const SpeechSpan& span, const std::atomic<bool>& cancelled) = 0;
  /// The sentences of a text. Made for all scripts; see SplitUtf8Sentences.
  virtual std::vector<std::string> Sentences(const std::string& text) const;
};

/// Cuts behind sentences (EndsSentence) and at line ends; pieces of over
/// kMaxSentenceBytes are cut at a comma or blank, else at a character. Pieces without a letter or
/// digit are left out. Control characters become blanks, what is no UTF-8 is dropped.
std::vector<std::string> SplitUtf8Sentences(std::string_view text);

}  // namespace ssm
