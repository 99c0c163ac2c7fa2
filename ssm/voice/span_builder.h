#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "ssm/voice/text_tags.h"

namespace ssm {

/// Collects text, pauses and marks into spans, each of one manner. What a markup's reader tells it
/// comes out in the same order.
class SpanBuilder {
 public:
  void Text(std::string_view text) { Text(text, text); }
  /// Written in one way and spoken in another.
  void Text(std::string_view written, std::string_view spoken) {
    span_.text += spoken;
    result_.plain += written;
    has_text_ = true;
  }
  /// Written and not spoken: a blank between sentences.
  void Written(std::string_view text) { result_.plain += text; }
  void Note(std::string note);
  void Pause(Millis length);
  void Mark(const std::string& name);
  void Audio(const std::string& path, const SpeechSpan::Clip& clip = {}, double volume = 1);
  /// The manner in force, without text. What is changed in it counts for the text that follows.
  SpeechSpan manner() const;
  void SetManner(SpeechSpan manner);
  /// The text that follows is a sentence of its own, whatever is before it.
  void BeginSentence();
  bool has_text() const { return has_text_; }
  TaggedText Finish();

 private:
  void Begin();
  void Cut();

  TaggedText result_;
  SpeechSpan span_;
  Millis pause_{0};
  std::string mark_;
  bool has_text_ = false;
  bool begins_sentence_ = false;
};

/// Slower, higher and louder by `amount` (1 = plain emphasis, negative = less than usual).
void Emphasize(SpeechSpan& manner, double amount);
/// Letters and digits one by one: "ab1" -> "A, B, 1".
std::string SpellOut(std::string_view text);
/// Digits with blanks between, other signs as pauses: "03-12" -> "0 3, 1 2".
std::string SpacedDigits(std::string_view text);
/// True for a reading in kana; the accent mark (’ or ') may stand in it.
bool IsKanaReading(std::string_view text);
/// The same without the accent mark.
std::string WithoutAccent(std::string_view kana);

}  // namespace ssm
