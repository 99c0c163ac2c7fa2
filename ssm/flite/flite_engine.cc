#include "ssm/flite/flite_engine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ssm/flite/ascii_text.h"
#include "ssm/flite/flite_assembly.h"
#include "ssm/voice/pronounced_text.h"

namespace ssm {
namespace {

/// Puts the engine's sound into the samples as it comes: what is left out at the beginning and
/// beyond the end, and how loud.
class Receiver {
 public:
  Receiver(const FliteUnit& unit, SampleBuffer& samples)
      : samples_(samples),
        skip_(ToFrames(unit.skip)),
        left_(ToFrames(unit.length)),
        volume_(unit.volume) {}
  std::size_t left() const { return left_; }

  bool Take(std::span<const std::int16_t> heard) {
    if (samples_.cancelled()) return false;
    const std::size_t skipped = std::min(skip_, heard.size());
    skip_ -= skipped;
    heard = heard.subspan(skipped);
    heard = heard.first(std::min(left_, heard.size()));
    left_ -= heard.size();
    std::array<std::int16_t, 800> scaled;
    while (!heard.empty()) {
      const std::size_t count = std::min(heard.size(), scaled.size());
      for (std::size_t i = 0; i < count; ++i) {
        const double value = volume_ > 1 ? Limited(heard[i] * volume_) : heard[i] * volume_;
        scaled[i] = static_cast<std::int16_t>(std::lround(value));
      }
      samples_.Append(std::span(scaled).first(count));
      heard = heard.subspan(count);
    }
    return left_ > 0;
  }

 private:
  SampleBuffer& samples_;
  std::size_t skip_;
  std::size_t left_;
  const double volume_;
};

class FliteEngine final : public SpeechEngine {
 public:
  const std::vector<VoiceInfo>& voices() const override { return library_.voices(); }
  vm::Result<SpeechPlan> Plan(const std::vector<SpeechSpan>& spans,
                              const std::atomic<bool>& cancelled) override;
  vm::Result<void> Render(const SpeechPlan& plan, SampleBuffer& samples) override;

 private:
  std::optional<FliteAnalysis> Analyse(const FliteSentence& sentence) const;
  const FliteLibrary library_;
};

std::optional<FliteAnalysis> FliteEngine::Analyse(const FliteSentence& sentence) const {
  std::optional<FliteAnalysis> found;
  FliteLibrary::Speak(sentence, {.analysed =
                                     [&](FliteAnalysis analysis) {
                                       found = std::move(analysis);
                                       return false;
                                     },
                                 .sound = [](std::span<const std::int16_t>) { return false; }});
  return found;
}

/// Names made for words with a pronunciation of their own; their written forms are the words.
void RestoreWords(FliteAnalysis& analysis, const EnglishText& text) {
  for (WordTime& word : analysis.words) {
    for (const auto& made : text.made) {
      if (word.text == made.name) word.text = made.written;
    }
  }
}

vm::Result<SpeechPlan> FliteEngine::Plan(const std::vector<SpeechSpan>& spans,
                                         const std::atomic<bool>& cancelled) {
  FliteAssembly assembly;
  std::string left_out;
  bool first = true;
  for (const SpeechSpan& span : spans) {
    assembly.Silence(span.pause_before);
    assembly.Mark(span.mark);
    const EnglishText english = NamePronounced(span.text);
    const AsciiText ascii = ToAscii(english.text);
    if (left_out.empty()) left_out = ascii.left_out;
    bool goes_on = span.begins_sentence;  // cut where a sentence ends
    for (std::string& sentence : SplitSentences(ascii.text)) {
      if (cancelled) return vm::Fail(vm::Errc::kStopped, "stopped while the text was prepared");
      FliteUnit unit{.sentence = {.text = std::move(sentence),
                                  .voice = span.voice,
                                  .stretch = span.stretch,
                                  .pitch = span.pitch},
                     .volume = span.volume};
      for (const auto& made : english.made) {
        unit.sentence.pronunciations.emplace_back(made.name, made.phonemes);
      }
      if (std::exchange(first, false)) {
        unit.take = std::make_shared<FliteTake>(unit.sentence);
      }
      auto analysis = unit.take ? unit.take->Analysis() : Analyse(unit.sentence);
      if (!analysis) return vm::Fail(vm::Errc::kUnavailable, "flite could not read the text");
      if (analysis->words.empty()) continue;  // signs that are not spoken
      RestoreWords(*analysis, english);
      assembly.Sentence(std::move(unit), std::move(*analysis), goes_on);
      goes_on = true;
    }
  }
  SpeechPlan plan = assembly.Finish();
  if (!left_out.empty()) {
    plan.unspoken = "flite speaks English only; left out: " + left_out;
  }
  return plan;
}

vm::Result<void> FliteEngine::Render(const SpeechPlan& plan, SampleBuffer& samples) {
  const auto* detail = dynamic_cast<const FliteDetail*>(plan.detail.get());
  if (detail == nullptr) return vm::Fail(vm::Errc::kInternal, "not a plan of this engine");
  for (const FliteUnit& unit : detail->units) {
    if (samples.cancelled()) return vm::Fail(vm::Errc::kStopped, "stopped while sound was made");
    Receiver receiver(unit, samples);
    const auto take = [&](std::span<const std::int16_t> heard) { return receiver.Take(heard); };
    if (unit.take) {
      unit.take->Sound(take);
    } else if (!unit.sentence.text.empty() &&
               !FliteLibrary::Speak(
                   unit.sentence,
                   {.analysed = [](const FliteAnalysis&) { return true; }, .sound = take})) {
      return vm::Fail(vm::Errc::kUnavailable, "flite could not speak the text");
    }
    if (samples.cancelled()) return vm::Fail(vm::Errc::kStopped, "stopped while sound was made");
    // The last segment's end and the sound's differ by a few ms (by half a pause with kal16).
    samples.AppendSilence(receiver.left());
  }
  samples.Finish();
  return {};
}

}  // namespace

std::unique_ptr<SpeechEngine> MakeFliteEngine() { return std::make_unique<FliteEngine>(); }

}  // namespace ssm
