#include "ssm/voice/span_builder.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

constexpr Millis kLongestPause{60'000};
constexpr std::string_view kAccentMark = "’";

}  // namespace

void SpanBuilder::Note(std::string note) {
  constexpr std::size_t kMostNotes = 20;
  if (result_.notes.size() < kMostNotes &&
      std::ranges::find(result_.notes, note) == result_.notes.end()) {
    result_.notes.push_back(std::move(note));
  }
}

void SpanBuilder::Pause(Millis length) {
  Cut();
  if (!mark_.empty()) {  // it stands before the pause
    const SpeechSpan next = manner();
    Begin();
    result_.spans.push_back(std::exchange(span_, next));
  }
  if (pause_ + length > kLongestPause) Note("pauses in a row are cut to 60 s");
  pause_ = std::min(pause_ + length, kLongestPause);
}

void SpanBuilder::Mark(const std::string& name) {
  Cut();
  // Two marks with nothing between them need a span each.
  if (!mark_.empty()) {
    Begin();
    result_.spans.push_back(std::exchange(span_, manner()));
  }
  mark_ = name;
}

void SpanBuilder::Audio(const std::string& path, const SpeechSpan::Clip& clip, double volume) {
  Cut();
  const SpeechSpan before = manner();
  Begin();
  span_.audio = path;
  span_.clip = clip;
  span_.volume *= volume;
  result_.spans.push_back(std::exchange(span_, before));
}

SpeechSpan SpanBuilder::manner() const {
  SpeechSpan manner = span_;
  manner.text.clear();
  manner.pause_before = Millis{0};
  manner.mark.clear();
  manner.audio.clear();
  manner.clip = {};
  manner.begins_sentence = false;
  return manner;
}

void SpanBuilder::SetManner(SpeechSpan manner) {
  Cut();
  span_ = std::move(manner);
}

void SpanBuilder::BeginSentence() {
  Cut();
  begins_sentence_ = true;
}

void SpanBuilder::Begin() {
  span_.pause_before = std::exchange(pause_, Millis{0});
  span_.mark = std::exchange(mark_, {});
}

/// Ends the present span if it has text.
void SpanBuilder::Cut() {
  if (span_.text.empty()) return;
  const SpeechSpan next = manner();
  Begin();
  span_.begins_sentence = std::exchange(begins_sentence_, false);
  result_.spans.push_back(std::exchange(span_, next));
}

TaggedText SpanBuilder::Finish() {
  Cut();
  if (pause_.count() > 0 || !mark_.empty()) {  // at the very end: they need a span to stand in
    Begin();
    result_.spans.push_back(std::move(span_));
  }
  return std::move(result_);
}

void Emphasize(SpeechSpan& manner, double amount) {
  manner.stretch *= std::pow(1.15, amount);
  manner.pitch *= std::pow(1.06, amount);
  manner.volume *= std::pow(1.25, amount);
}

std::string SpellOut(std::string_view text) {
  std::string spelled;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    while (end < text.size() && !vm::BeginsSign(text[end])) ++end;
    std::string one(text.substr(at, end - at));
    at = end;
    const auto byte = static_cast<unsigned char>(one[0]);
    if (byte < 0x80 && std::isalnum(byte) == 0) continue;
    if (byte < 0x80) one[0] = static_cast<char>(std::toupper(byte));
    spelled += (spelled.empty() ? "" : ", ") + one;
  }
  return spelled;
}

std::string SpacedDigits(std::string_view text) {
  std::string spaced;
  bool sign = false;
  for (const char c : text) {
    if (c < '0' || c > '9') {
      sign = !spaced.empty();
      continue;
    }
    if (!spaced.empty()) spaced += sign ? ", " : " ";
    spaced += c;
    sign = false;
  }
  return spaced;
}

std::string WithoutAccent(std::string_view kana) {
  std::string plain;
  while (!kana.empty()) {
    if (kana.starts_with(kAccentMark)) {
      kana.remove_prefix(kAccentMark.size());
    } else {
      if (kana.front() != '\'') plain += kana.front();
      kana.remove_prefix(1);
    }
  }
  return plain;
}

bool IsKanaReading(std::string_view text) {
  const std::string plain = WithoutAccent(text);
  if (plain.empty() || plain.size() % 3 != 0) return false;
  for (std::size_t at = 0; at < plain.size(); at += 3) {  // U+3041 to U+30FF: E3 81 81 to E3 83 BF
    const auto second = static_cast<unsigned char>(plain[at + 1]);
    if (static_cast<unsigned char>(plain[at]) != 0xE3 || second < 0x81 || second > 0x83)
      return false;
  }
  return true;
}

}  // namespace ssm
