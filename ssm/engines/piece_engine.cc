#include "ssm/engines/piece_engine.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "ssm/engines/wav_piece.h"
#include "ssm/flite/ascii_text.h"
#include "ssm/voice/pronounced_text.h"
#include "ssm/voice/sentences.h"
#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

/// A sentence's sound, or a pause.
struct Part {
  std::size_t frames = 0;
  double volume = 1;
  Piece sound{};  ///< its samples and `later` only
};

struct PieceDetail : SpeechPlan::Detail {
  std::vector<Part> parts;
};

void AddPause(vm::PhonemeList& phonemes, Millis length) {
  if (length.count() <= 0) return;
  if (!phonemes.empty() && phonemes.back().name == "pau") {
    phonemes.back().duration += length;
  } else {
    phonemes.push_back({"pau", length});
  }
}

/// Joins pieces into one plan and one sound.
class Joiner {
 public:
  void Pause(Millis length) {
    AddPause(plan_.phonemes, length);
    AddPart({.frames = ToFrames(length)});
  }
  void Mark(const std::string& name) {
    if (!name.empty()) plan_.marks.push_back({name, ToMs(frames_)});
  }
  void Add(Piece piece, double volume) {
    const Millis start = ToMs(frames_);
    for (WordTime& word : piece.words) {
      plan_.words.push_back({std::move(word.text), word.start + start, word.end + start});
    }
    AddPart({.frames = ToFrames(vm::TotalDuration(piece.phonemes)),
             .volume = volume,
             .sound = {.samples = std::move(piece.samples), .later = std::move(piece.later)}});
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
  void AddPart(Part part) {
    frames_ += part.frames;
    detail_->parts.push_back(std::move(part));
  }
  SpeechPlan plan_;
  std::size_t frames_ = 0;
  std::shared_ptr<PieceDetail> detail_ = std::make_shared<PieceDetail>();
};

bool IsWideSign(std::string_view c) {
  return c == "。" || c == "！" || c == "？" || c == "．" || c == "、" || c == "，" || c == "　" ||
         c == "「" || c == "」" || c == "・" || c == "…" || c == "—" || c == "–" || c == "“" ||
         c == "”";
}

bool HasSomethingToSay(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t bytes = vm::SignAt(text, at).length;
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
    if (Expresses(span.feeling.name)) {
      sentence.stretch *= span.feeling.manner.rate;
      sentence.pitch /= span.feeling.manner.pitch;
      sentence.volume /= span.feeling.manner.volume;
    }
    const std::string said = TakesPronunciations() ? span.text : AsWritten(span.text);
    for (std::string& text : Sentences(said)) {
      if (cancelled) return vm::Fail(vm::Errc::kStopped, "stopped while the text was prepared");
      sentence.text = std::move(text);
      auto piece = Speak(sentence, cancelled);
      if (!piece) return std::unexpected(piece.error());
      joiner.Add(std::move(*piece), sentence.volume);
    }
  }
  return joiner.Finish();
}

vm::Result<void> PieceEngine::Render(const SpeechPlan& plan, SampleBuffer& samples) {
  const auto* detail = dynamic_cast<const PieceDetail*>(plan.detail.get());
  if (detail == nullptr) return vm::Fail(vm::Errc::kInternal, "not a plan of this engine");
  for (const Part& part : detail->parts) {
    if (samples.cancelled()) return vm::Fail(vm::Errc::kStopped, "stopped while sound was made");
    vm::Result<std::vector<std::int16_t>> sound = part.sound.samples;
    if (part.sound.later) sound = part.sound.later();
    if (!sound) return std::unexpected(sound.error());
    sound->resize(part.frames);
    ScaleSamples(*sound, part.volume);
    samples.Append(*sound);
  }
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
    const std::size_t bytes = vm::SignAt(text, at).length;
    const std::string_view c = std::string_view(text).substr(at, bytes);
    if (at - begin + bytes > kMaxSentenceBytes) cut(room > begin ? room : at);
    at += bytes;
    if (c == "\n" || EndsSentence(text, at - bytes)) {
      cut(at);
    } else if (c == " " || c == "、" || c == "，" || c == ",") {
      room = at;
    }
  }
  cut(text.size());
  return sentences;
}

}  // namespace ssm
