#pragma once

#include <memory>
#include <string>
#include <vector>

#include "srm/align/phone_aligner.h"

namespace srm {

/// What is said in a recording, without its text: words by the model's dictation, and when their
/// phonemes are spoken. The confidence of words is that of the piece between pauses they are in:
/// how well they fit, and how likely they are among all words. A piece whose words have none,
/// because it is another language or hardly speech, has no words, but the phonemes that fit best.
/// Takes about a third of the sound's time. Thread: one.
class SpeechGuesser {
 public:
  /// Error: kUnavailable (no model).
  static vm::Result<std::unique_ptr<SpeechGuesser>> Open(const std::string& model);
  ~SpeechGuesser();
  Alignment Guess(const std::vector<std::int16_t>& samples);

 private:
  struct Parts;
  explicit SpeechGuesser(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// A part of a sound that is heard on its own.
struct SoundPiece {
  Millis start{0}, end{0};
};
/// Pieces of at most `longest`, one behind the other, cut in the middle of pauses where there are
/// some. REQUIRES: longest > 0.
std::vector<SoundPiece> PiecesOf(const vm::PhonemeList& phonemes, Millis longest);

}  // namespace srm
