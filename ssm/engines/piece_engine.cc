#include "ssm/engines/piece_engine.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "ssm/flite/ascii_text.h"
#include "ssm/voice/pronounced_text.h"
#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

struct PieceDetail : SpeechPlan::Detail {
  std::vector<std::int16_t> samples;
};

void AddPause(vm::PhonemeList& phonemes, Millis length) {
  if (length.count() <= 0) return;
  if (!phonemes.empty() && phonemes.back().name == "pau") {
    phonemes.back().duration += length;
  } else {
    phonemes.push_back({"pau", length});
  }
}

std::int16_t Scaled(std::int16_t sample, double volume) {
  return static_cast<std::int16_t>(std::lround(std::clamp(sample * volume, -32768.0, 32767.0)));
}

/// Joins pieces into one plan and one sound.
class Joiner {
 public:
  void Pause(Millis length) {
    AddPause(plan_.phonemes, length);
    detail_->samples.resize(detail_->samples.size() + ToFrames(length));
  }
  void Mark(const std::string& name) {
    if (!name.empty()) plan_.marks.push_back({name, Now()});
  }
  void Add(Piece piece, double volume) {
    const Millis start = Now();
    for (WordTime& word : piece.words) {
      plan_.words.push_back({std::move(word.text), word.start + start, word.end + start});
    }
    const std::size_t frames = ToFrames(vm::TotalDuration(piece.phonemes));
    piece.samples.resize(frames);
    for (const std::int16_t sample : piece.samples) {
      detail_->samples.push_back(Scaled(sample, volume));
    }
    for (vm::Phoneme& phoneme : piece.phonemes) {
      if (phoneme.name == "pau") {
        AddPause(plan_.phonemes, phoneme.duration);
      } else if (phoneme.duration.count() > 0) {
        plan_.phonemes.push_back(std::move(phoneme));
      }
    }
    if (plan_.unspoken.empty()) plan_.unspoken = std::move(piece.unspoken);
  }
  SpeechPlan Finish() {
    if (plan_.phonemes.empty()) Pause(kEmptyPause);
    plan_.detail = std::move(detail_);
    return std::move(plan_);
  }

 private:
  Millis Now() const { return ToMs(detail_->samples.size()); }
  SpeechPlan plan_;
  std::shared_ptr<PieceDetail> detail_ = std::make_shared<PieceDetail>();
};

std::size_t CharacterBytes(unsigned char first) {
  return first < 0x80 ? 1 : first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
}

bool IsWideStop(std::string_view c) { return c == "。" || c == "！" || c == "？" || c == "．"; }
bool IsWideSign(std::string_view c) {
  return IsWideStop(c) || c == "、" || c == "，" || c == "　" || c == "「" || c == "」" ||
         c == "・" || c == "…" || c == "—" || c == "–" || c == "“" || c == "”";
}

bool HasSomethingToSay(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t bytes = CharacterBytes(static_cast<unsigned char>(text[at]));
    const std::string_view c = text.substr(at, bytes);
    if (bytes == 1 ? std::isalnum(static_cast<unsigned char>(c[0])) != 0 || c[0] == '%' ||
                         c[0] == '$' || c[0] == '&' || c[0] == '@'
                   : !IsWideSign(c)) {
      return true;
    }
    at += bytes;
  }
  return false;
}

/// Well-formed UTF-8 without control characters but line ends.
std::string Cleaned(std::string_view text) {
  std::string clean;
  while (!text.empty()) {
    const std::size_t good = vm::FirstBadUtf8(text).value_or(text.size());
    for (const char c : text.substr(0, good)) {
      const bool control = (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7F;
      clean += control ? ' ' : c;
    }
    text.remove_prefix(std::min(good + 1, text.size()));
  }
  return clean;
}

}  // namespace

vm::Result<SpeechPlan> PieceEngine::Plan(const std::vector<SpeechSpan>& spans,
                                         const std::atomic<bool>& cancelled) {
  Joiner joiner;
  for (const SpeechSpan& span : spans) {
    joiner.Pause(span.pause_before);
    joiner.Mark(span.mark);
    SpeechSpan sentence = span;
    const std::string said = TakesPronunciations() ? span.text : AsWritten(span.text);
    for (std::string& text : Sentences(said)) {
      if (cancelled) return vm::Fail(vm::Errc::kStopped, "stopped while the text was prepared");
      sentence.text = std::move(text);
      auto piece = Speak(sentence, cancelled);
      if (!piece) return std::unexpected(piece.error());
      joiner.Add(std::move(*piece), span.volume);
    }
  }
  return joiner.Finish();
}

vm::Result<void> PieceEngine::Render(const SpeechPlan& plan, SampleBuffer& samples) {
  const auto* detail = dynamic_cast<const PieceDetail*>(plan.detail.get());
  if (detail == nullptr) return vm::Fail(vm::Errc::kInternal, "not a plan of this engine");
  samples.Append(detail->samples);
  samples.Finish();
  return {};
}

std::vector<std::string> PieceEngine::Sentences(const std::string& text) const {
  return SplitUtf8Sentences(text);
}

std::vector<std::string> SplitUtf8Sentences(std::string_view raw) {
  const std::string text = Cleaned(raw);
  std::vector<std::string> sentences;
  std::size_t begin = 0, room = 0;  // room: the last place where a long one may be cut
  const auto cut = [&](std::size_t end) {
    const std::string_view piece = std::string_view(text).substr(begin, end - begin);
    if (HasSomethingToSay(piece)) sentences.emplace_back(piece);
    begin = room = end;
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t bytes = CharacterBytes(static_cast<unsigned char>(text[at]));
    const std::string_view c = std::string_view(text).substr(at, bytes);
    if (at - begin + bytes > kMaxSentenceBytes) cut(room > begin ? room : at);
    at += bytes;
    const bool blank_next = at >= text.size() || text[at] == ' ' || text[at] == '\n';
    const bool stop = c == "." || c == "!" || c == "?";
    if (IsWideStop(c) || c == "\n" || (stop && blank_next)) {
      cut(at);
    } else if (c == " " || c == "、" || c == "，" || c == ",") {
      room = at;
    }
  }
  cut(text.size());
  return sentences;
}

}  // namespace ssm
