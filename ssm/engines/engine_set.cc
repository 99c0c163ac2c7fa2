#include "ssm/engines/engine_set.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "ssm/engines/language_runs.h"
#include "ssm/engines/wav_piece.h"
#include "ssm/voice/language_tag.h"
#include "ssm/voice/resample.h"

namespace ssm {
namespace {

bool IsPause(const vm::Phoneme& phoneme) { return phoneme.name == "pau" || phoneme.name == "sil"; }

/// A part of the plan as its engine made it.
struct SpokenPart {
  SpeechEngine* engine = nullptr;  ///< null: `samples`
  SpeechPlan plan;
  std::vector<std::int16_t> samples;
  Millis made{0};  ///< all the engine makes
  Millis skip{0};  ///< of that, left out at the beginning
  Millis length{0};
};

struct SetDetail : SpeechPlan::Detail {
  std::vector<SpokenPart> parts;
};

bool EndsInSign(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \"')");
  if (last == std::string_view::npos) return false;
  text = text.substr(0, last + 1);
  for (const std::string_view sign : {".", ",", ";", ":", "!", "?", "。", "、", "！", "？", "，"}) {
    if (text.ends_with(sign)) return true;
  }
  return false;
}

/// The engine's silence at the end, beyond the joint, is left out.
void CutEnd(SpokenPart& part, vm::PhonemeList& phonemes) {
  if (phonemes.size() < 2 || !IsPause(phonemes.back())) return;
  const Millis cut =
      phonemes.back().duration - std::min(phonemes.back().duration, EngineSet::kJoint);
  phonemes.back().duration -= cut;
  part.length -= cut;
}

void CutBegin(SpokenPart& part, vm::PhonemeList& phonemes) {
  if (phonemes.size() < 2 || !IsPause(phonemes.front())) return;
  part.skip = phonemes.front().duration;
  part.length -= part.skip;
  phonemes.erase(phonemes.begin());
}

/// Puts the parts' phonemes, words and marks one behind the other.
void Join(SpeechPlan& whole, const SpokenPart& part, const SpeechPlan& plan, Millis start) {
  const auto moved = [&](Millis at) {
    return start + std::clamp(at - part.skip, Millis{0}, part.length);
  };
  for (const WordTime& word : plan.words) {
    whole.words.push_back({word.text, moved(word.start), moved(word.end)});
  }
  for (const MarkTime& mark : plan.marks) whole.marks.push_back({mark.name, moved(mark.at)});
  if (whole.unspoken.empty()) whole.unspoken = plan.unspoken;
  for (const vm::Phoneme& phoneme : plan.phonemes) {
    auto& list = whole.phonemes;
    if (!list.empty() && IsPause(list.back()) && IsPause(phoneme)) {
      list.back().duration += phoneme.duration;
    } else if (phoneme.duration.count() > 0) {
      list.push_back(phoneme);
    }
  }
}

/// The file's sound as the clip wants it. `cut`: its repeats would take longer than they may.
std::vector<std::int16_t> Clipped(std::vector<std::int16_t> file, const SpeechSpan::Clip& clip,
                                  bool& cut) {
  const std::size_t begin = std::min(ToFrames(clip.begin), file.size());
  const std::size_t end =
      clip.end.count() > 0 ? std::min(ToFrames(clip.end), file.size()) : file.size();
  std::vector<std::int16_t> once(file.begin() + static_cast<std::ptrdiff_t>(begin),
                                 file.begin() + static_cast<std::ptrdiff_t>(std::max(begin, end)));
  if (clip.speed != 1 && !once.empty()) {
    once = Resample(once, std::llround(kSampleRateHz * clip.speed), kSampleRateHz);
  }
  const std::size_t most =
      ToFrames(clip.most.count() > 0 ? std::min(clip.most, kLongestPlayed) : kLongestPlayed);
  const auto wanted = static_cast<double>(once.size()) * clip.repeats;
  cut = clip.repeats != 1 && clip.most.count() == 0 && wanted > static_cast<double>(most);
  std::vector<std::int16_t> sound;
  const auto length = static_cast<std::size_t>(std::min(
      wanted,
      static_cast<double>(clip.repeats == 1 && clip.most.count() == 0 ? once.size() : most)));
  while (sound.size() < length && !once.empty()) {
    const std::size_t more = std::min(once.size(), length - sound.size());
    sound.insert(sound.end(), once.begin(), once.begin() + static_cast<std::ptrdiff_t>(more));
  }
  return sound;
}

vm::Result<SpokenPart> PlayedFile(const SpeechSpan& span) {
  auto samples = ReadSoundFile(span.audio);
  if (!samples) return std::unexpected(samples.error());
  bool cut = false;
  *samples = Clipped(std::move(*samples), span.clip, cut);
  SpokenPart part;
  if (cut) {
    part.plan.unspoken = "'" + span.audio + "' is repeated for " +
                         std::to_string(kLongestPlayed.count() / 1000) + " s, the limit";
  }
  ScaleSamples(*samples, span.volume);
  const Millis sound = ToMs(samples->size());
  samples->insert(samples->begin(), ToFrames(span.pause_before), 0);
  if (!span.mark.empty()) part.plan.marks.push_back({span.mark, span.pause_before});
  part.made = part.length = span.pause_before + sound;
  samples->resize(ToFrames(part.length));
  part.plan.phonemes = {{"pau", part.length}};
  part.samples = std::move(*samples);
  return part;
}

}  // namespace

EngineSet::EngineSet(std::vector<std::unique_ptr<SpeechEngine>> engines)
    : engines_(std::move(engines)) {
  assert(!engines_.empty());
  for (std::size_t i = 0; i < engines_.size(); ++i) {
    for (const VoiceInfo& voice : engines_[i]->voices()) {
      voices_.push_back(voice);
      engine_of_.push_back(i);
    }
  }
}

bool EngineSet::Speaks(const std::string& language) const {
  return std::ranges::any_of(engines_, [&](const auto& it) { return it->Speaks(language); });
}

std::size_t EngineSet::IndexOf(std::string_view voice) const {
  for (std::size_t i = 0; i < voices_.size(); ++i) {
    if (voices_[i].name == voice) return i;
  }
  return 0;
}

vm::Result<void> EngineSet::ChooseVoice(const std::string& language, const std::string& voice) {
  const std::size_t index = IndexOf(voice);
  if (voices_[index].name != voice) {
    return vm::Fail(vm::Errc::kBadValue, "unknown speaker '" + voice + "'");
  }
  const std::lock_guard lock(mutex_);
  chosen_[language] = index;
  return {};
}

std::size_t EngineSet::VoiceFor(const std::string& language, std::size_t base) const {
  const std::lock_guard lock(mutex_);
  if (const auto chosen = chosen_.find(language); chosen != chosen_.end()) return chosen->second;
  std::size_t found = base;
  for (std::size_t i = 0; i < voices_.size(); ++i) {
    if (voices_[i].language != language) continue;
    if (voices_[i].female == voices_[base].female) return i;
    if (found == base) found = i;
  }
  return found;
}

std::string EngineSet::LanguageOfIdeographs(const std::vector<SpeechSpan>& spans) const {
  Ideographs all;
  for (const SpeechSpan& span : spans) {
    const Ideographs found = FindIdeographs(span.text);
    all.kana = all.kana || found.kana;
    all.beyond_japanese = all.beyond_japanese || found.beyond_japanese;
  }
  return all.beyond_japanese && !all.kana && Speaks("zh") ? "zh" : "ja";
}

std::vector<EngineSet::Run> EngineSet::Runs(const std::vector<SpeechSpan>& spans,
                                            const std::string& ideographs) const {
  std::vector<Run> runs;
  const auto add = [&](SpeechSpan span, std::size_t voice, bool joined) {
    const std::size_t engine = engine_of_[voice];
    span.voice = voices_[voice].name;
    const bool file = !span.audio.empty();
    if (runs.empty() || runs.back().engine != engine || file ||
        !runs.back().spans.back().audio.empty()) {
      runs.push_back({engine, {}, joined});
    }
    runs.back().spans.push_back(std::move(span));
  };
  std::string before;  // what was said last, if nothing parts it from what follows
  for (const SpeechSpan& span : spans) {
    const std::size_t base = IndexOf(span.voice);
    std::vector<LanguageRun> pieces =
        span.language.empty() ? SplitLanguages(span.text, voices_[base].language, ideographs)
                              : SplitAsked(span.text, PrimaryLanguage(span.language));
    if (span.pause_before.count() > 0 || span.begins_sentence) before.clear();
    if (!span.audio.empty() || pieces.empty()) {
      add(span, base, false);
      before.clear();
      continue;
    }
    SpeechSpan part = span;
    for (const LanguageRun& piece : pieces) {
      part.text = piece.text;
      const bool own = piece.language == voices_[base].language;
      add(part, own ? base : VoiceFor(piece.language, base),
          !before.empty() && !EndsInSign(before));
      before = piece.text;
      part.pause_before = Millis{0};
      part.mark.clear();
    }
  }
  return runs;
}

bool EngineSet::Prompt(const std::vector<SpeechSpan>& spans) const {
  const std::vector<Run> runs = Runs(spans, LanguageOfIdeographs(spans));
  return std::all_of(runs.begin(), runs.end(), [this](const Run& run) {
    return run.spans.front().audio.empty() && engines_[run.engine]->Prompt(run.spans);
  });
}

vm::Result<SpeechPlan> EngineSet::Plan(const std::vector<SpeechSpan>& spans,
                                       const std::atomic<bool>& cancelled) {
  const std::string ideographs = LanguageOfIdeographs(spans);
  auto plan = PlanRuns(Runs(spans, ideographs), cancelled);
  if (!plan || plan->unspoken.empty() || ideographs == "zh" || !Speaks("zh")) return plan;
  const auto any = [&](bool Ideographs::*is) {
    return std::ranges::any_of(spans, [&](const SpeechSpan& span) {
      return span.language.empty() && FindIdeographs(span.text).*is;
    });
  };
  if (!any(&Ideographs::any) || any(&Ideographs::kana)) return plan;
  // Rather the whole of it in Chinese than half in Japanese.
  auto chinese = PlanRuns(Runs(spans, "zh"), cancelled);
  return chinese && chinese->unspoken.empty() ? std::move(chinese) : std::move(plan);
}

vm::Result<SpeechPlan> EngineSet::PlanRuns(const std::vector<Run>& runs,
                                           const std::atomic<bool>& cancelled) {
  auto detail = std::make_shared<SetDetail>();
  for (const Run& run : runs) {
    SpokenPart part;
    if (!run.spans.front().audio.empty()) {
      auto played = PlayedFile(run.spans.front());
      if (!played) return std::unexpected(played.error());
      part = std::move(*played);
    } else {
      part.engine = engines_[run.engine].get();
      auto plan = part.engine->Plan(run.spans, cancelled);
      if (!plan) return std::unexpected(plan.error());
      part.plan = std::move(*plan);
      part.made = part.length = vm::TotalDuration(part.plan.phonemes);
    }
    detail->parts.push_back(std::move(part));
  }
  SpeechPlan whole;
  Millis at{0};
  for (std::size_t i = 0; i < detail->parts.size(); ++i) {
    SpokenPart& part = detail->parts[i];
    SpeechPlan view = part.plan;
    if (i + 1 < runs.size() && runs[i + 1].joined) CutEnd(part, view.phonemes);
    if (runs[i].joined) CutBegin(part, view.phonemes);
    Join(whole, part, view, at);
    at += part.length;
  }
  if (whole.phonemes.empty()) {
    whole.phonemes = {{"pau", kEmptyPause}};
    detail->parts.clear();
  }
  whole.detail = std::move(detail);
  return whole;
}

vm::Result<void> EngineSet::Render(const SpeechPlan& plan, SampleBuffer& samples) {
  const auto* detail = dynamic_cast<const SetDetail*>(plan.detail.get());
  if (detail == nullptr) return vm::Fail(vm::Errc::kInternal, "not a plan of this set");
  for (const SpokenPart& part : detail->parts) {
    if (samples.cancelled()) return vm::Fail(vm::Errc::kStopped, "stopped while sound was made");
    const bool whole = part.skip.count() == 0 && part.length == part.made;
    if (part.engine == nullptr) {
      samples.Append(part.samples);
    } else if (detail->parts.size() == 1 && whole) {
      return part.engine->Render(part.plan, samples);  // the first sound does not wait for the last
    } else {
      SampleBuffer own(ToFrames(part.made));
      if (auto made = part.engine->Render(part.plan, own); !made) return made;
      samples.Append(own.Ready().subspan(ToFrames(part.skip), ToFrames(part.length)));
    }
  }
  samples.Finish();
  return {};
}

}  // namespace ssm
