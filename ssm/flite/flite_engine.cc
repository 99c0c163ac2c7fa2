#include "ssm/flite/flite_engine.h"

extern "C" {
#include <flite/flite.h>

// The voices' libraries come without headers.
cst_voice* register_cmu_us_slt(const char* voxdir);
cst_voice* register_cmu_us_rms(const char* voxdir);
cst_voice* register_cmu_us_awb(const char* voxdir);
cst_voice* register_cmu_us_kal16(const char* voxdir);
}

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <string_view>
#include <utility>

#include "ssm/flite/ascii_text.h"

namespace ssm {
namespace {

constexpr int kChunkFrames = 800;  // 50 ms: the step in which sound comes and can be stopped

struct FliteVoice {
  VoiceInfo info;
  cst_voice* (*register_voice)(const char*);
  cst_voice* voice = nullptr;
  cst_audio_streaming_info* streaming = nullptr;  // owned by the voice's features
};

/// flite's voices are variables of the process, and a voice is changed by every use of it.
std::mutex& LibraryMutex() {
  static std::mutex mutex;
  return mutex;
}

struct UtteranceDeleter {
  void operator()(cst_utterance* utterance) const { delete_utterance(utterance); }
};
using UtterancePtr = std::unique_ptr<cst_utterance, UtteranceDeleter>;

/// One call of the engine: a sentence, or a silence where `text` is empty.
struct Unit {
  std::string text;
  std::string voice;
  double stretch = 1;
  double pitch = 1;
  double volume = 1;
  Millis skip{0};  ///< what of the engine's sound at its beginning is left out
  Millis length{0};
};

struct FliteDetail : SpeechPlan::Detail {
  std::vector<Unit> units;
};

/// What flite says of a sentence.
struct Analysis {
  vm::PhonemeList phonemes;
  std::vector<WordTime> words;
};

Millis Rounded(float seconds) { return Millis(std::lround(static_cast<double>(seconds) * 1000.0)); }

Analysis ReadSegments(cst_utterance* utterance) {
  Analysis analysis;
  Millis at{0};
  const cst_item* word = nullptr;
  for (const cst_item* segment = relation_head(utt_relation(utterance, "Segment"));
       segment != nullptr; segment = item_next(segment)) {
    const Millis end = std::max(Rounded(item_feat_float(segment, "end")), at);
    const cst_item* its_word = flite_path_to_item(segment, "R:SylStructure.parent.parent");
    if (its_word != nullptr && its_word == word) {
      analysis.words.back().end = end;
    } else if (its_word != nullptr) {
      analysis.words.push_back({item_feat_string(its_word, "name"), at, end});
    }
    word = its_word;
    if (end > at) analysis.phonemes.push_back({item_feat_string(segment, "name"), end - at});
    at = end;
  }
  return analysis;
}

bool IsPause(const vm::Phoneme& phoneme) { return phoneme.name == "pau"; }

/// Takes sound as flite makes it. Lives during one synthesis.
struct Receiver {
  SampleBuffer* samples = nullptr;  // null: no sound is wanted, only the analysis
  std::size_t skip = 0;             // frames left out at the beginning
  std::size_t left = 0;             // frames still wanted
  double volume = 1;
};

int OnSound(const cst_wave* wave, int start, int size, int, cst_audio_streaming_info* info) {
  auto& receiver = *static_cast<Receiver*>(info->userdata);
  if (receiver.samples == nullptr || receiver.samples->cancelled()) return CST_AUDIO_STREAM_STOP;
  std::span<const short> heard(wave->samples + start, static_cast<std::size_t>(size));
  const std::size_t skipped = std::min(receiver.skip, heard.size());
  receiver.skip -= skipped;
  heard = heard.subspan(skipped);
  heard = heard.first(std::min(receiver.left, heard.size()));
  receiver.left -= heard.size();
  std::array<std::int16_t, kChunkFrames> scaled;
  while (!heard.empty()) {
    const std::size_t count = std::min(heard.size(), scaled.size());
    for (std::size_t i = 0; i < count; ++i) {
      const double value = std::clamp(heard[i] * receiver.volume, -32768.0, 32767.0);
      scaled[i] = static_cast<std::int16_t>(std::lround(value));
    }
    receiver.samples->Append(std::span(scaled).first(count));
    heard = heard.subspan(count);
  }
  return receiver.left > 0 ? CST_AUDIO_STREAM_CONT : CST_AUDIO_STREAM_STOP;
}

class FliteEngine final : public SpeechEngine {
 public:
  FliteEngine() {
    for (const FliteVoice& voice : voices_) infos_.push_back(voice.info);
    const std::lock_guard lock(LibraryMutex());
    flite_init();
  }

  const std::vector<VoiceInfo>& voices() const override { return infos_; }

  vm::Result<SpeechPlan> Plan(const std::vector<SpeechSpan>& spans,
                              const std::atomic<bool>& cancelled) override;
  vm::Result<void> Render(const SpeechPlan& plan, SampleBuffer& samples) override;

 private:
  FliteVoice& Find(std::string_view name);
  UtterancePtr Synthesize(const Unit& unit, Receiver& receiver);

  std::array<FliteVoice, 4> voices_{
      {{{.name = "slt", .language = "en", .female = true}, register_cmu_us_slt},
       // rms models its pitch in a way that takes no shift.
       {{.name = "rms", .language = "en", .pitch_adjustable = false}, register_cmu_us_rms},
       {{.name = "awb", .language = "en"}, register_cmu_us_awb},
       {{.name = "kal16", .language = "en"}, register_cmu_us_kal16}}};
  std::vector<VoiceInfo> infos_;
};

/// The voice, made known to flite. REQUIRES: the library's mutex is held.
FliteVoice& FliteEngine::Find(std::string_view name) {
  auto found = std::find_if(voices_.begin(), voices_.end(),
                            [&](const FliteVoice& voice) { return voice.info.name == name; });
  if (found == voices_.end()) found = voices_.begin();
  if (found->voice == nullptr) {
    found->voice = found->register_voice(nullptr);
    found->streaming = new_audio_streaming_info();
    found->streaming->min_buffsize = kChunkFrames;
    found->streaming->asc = OnSound;
    feat_set(found->voice->features, "streaming_info", audio_streaming_info_val(found->streaming));
  }
  return *found;
}

UtterancePtr FliteEngine::Synthesize(const Unit& unit, Receiver& receiver) {
  const std::lock_guard lock(LibraryMutex());
  FliteVoice& voice = Find(unit.voice);
  voice.streaming->userdata = &receiver;
  feat_set_float(voice.voice->features, "duration_stretch", static_cast<float>(unit.stretch));
  feat_set_float(voice.voice->features, "f0_shift", static_cast<float>(unit.pitch));
  UtterancePtr utterance(flite_synth_text(unit.text.c_str(), voice.voice));
  voice.streaming->userdata = nullptr;
  return utterance;
}

/// Collects units into one list of phonemes, and decides what happens where two of them meet.
class Assembly {
 public:
  void Silence(Millis length) {
    if (length.count() > 0) Pause(length);
  }
  void Mark(const std::string& name) {
    if (!name.empty()) plan_.marks.push_back({name, at_});
  }
  /// `same_span`: the unit before is the sentence before it; else it may have been cut anywhere.
  void Sentence(Unit unit, Analysis analysis, bool same_span) {
    auto& phonemes = analysis.phonemes;
    if (spoke_ && !same_span) {
      // The manner changes inside a sentence: the engine's pauses there are none of the text's.
      if (phonemes.size() > 1 && IsPause(phonemes.front())) {
        unit.skip = phonemes.front().duration;
        phonemes.erase(phonemes.begin());
      }
      if (!punctuated_) DropLastPause();
    }
    unit.length = vm::TotalDuration(phonemes);
    for (WordTime word : analysis.words) {
      word.start += at_ - unit.skip;
      word.end += at_ - unit.skip;
      plan_.words.push_back(std::move(word));
    }
    const std::size_t last = unit.text.find_last_not_of(" \"')");
    punctuated_ = last != std::string::npos && std::string_view(".,;:!?").contains(unit.text[last]);
    spoke_ = true;
    for (vm::Phoneme& phoneme : phonemes) Add(std::move(phoneme));
    units_.push_back(std::move(unit));
  }
  SpeechPlan Finish() {
    if (plan_.phonemes.empty()) Pause(kEmptyPause);
    auto detail = std::make_shared<FliteDetail>();
    detail->units = std::move(units_);
    plan_.detail = std::move(detail);
    return std::move(plan_);
  }

 private:
  void Add(vm::Phoneme phoneme) {
    at_ += phoneme.duration;
    if (!plan_.phonemes.empty() && IsPause(plan_.phonemes.back()) && IsPause(phoneme)) {
      plan_.phonemes.back().duration += phoneme.duration;
    } else {
      plan_.phonemes.push_back(std::move(phoneme));
    }
  }
  void Pause(Millis length) {
    units_.push_back({.text = {}, .voice = {}, .length = length});
    Add({"pau", length});
  }
  void DropLastPause() {
    // Only of a sentence: a silence asked for (an empty unit) stays.
    if (units_.empty() || units_.back().text.empty() || plan_.phonemes.size() < 2) return;
    vm::Phoneme& last = plan_.phonemes.back();
    if (!IsPause(last) || last.duration >= units_.back().length) return;
    at_ -= last.duration;
    units_.back().length -= last.duration;
    for (MarkTime& mark : plan_.marks) mark.at = std::min(mark.at, at_);
    plan_.phonemes.pop_back();
  }

  SpeechPlan plan_;
  std::vector<Unit> units_;
  Millis at_{0};
  bool spoke_ = false;
  bool punctuated_ = false;
};

vm::Result<SpeechPlan> FliteEngine::Plan(const std::vector<SpeechSpan>& spans,
                                         const std::atomic<bool>& cancelled) {
  Assembly assembly;
  std::string left_out;
  for (const SpeechSpan& span : spans) {
    assembly.Silence(span.pause_before);
    assembly.Mark(span.mark);
    const AsciiText ascii = ToAscii(span.text);
    if (left_out.empty()) left_out = ascii.left_out;
    bool same_span = false;
    for (std::string& sentence : SplitSentences(ascii.text)) {
      if (cancelled) return vm::Fail(vm::Errc::kStopped, "stopped while the text was prepared");
      Unit unit{std::move(sentence), span.voice, span.stretch, span.pitch, span.volume, {}, {}};
      Receiver receiver;
      const UtterancePtr utterance = Synthesize(unit, receiver);
      if (!utterance) return vm::Fail(vm::Errc::kUnavailable, "flite could not read the text");
      Analysis analysis = ReadSegments(utterance.get());
      if (analysis.words.empty()) continue;  // signs that are not spoken
      assembly.Sentence(std::move(unit), std::move(analysis), same_span);
      same_span = true;
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
  for (const Unit& unit : detail->units) {
    if (samples.cancelled()) return vm::Fail(vm::Errc::kStopped, "stopped while sound was made");
    Receiver receiver;
    receiver.samples = &samples;
    receiver.skip = ToFrames(unit.skip);
    receiver.left = ToFrames(unit.length);
    receiver.volume = unit.volume;
    if (!unit.text.empty() && !Synthesize(unit, receiver)) {
      return vm::Fail(vm::Errc::kUnavailable, "flite could not speak the text");
    }
    if (samples.cancelled()) return vm::Fail(vm::Errc::kStopped, "stopped while sound was made");
    // The last segment's end and the sound's differ by a few ms (by half a pause with kal16).
    samples.AppendSilence(receiver.left);
  }
  samples.Finish();
  return {};
}

}  // namespace

std::unique_ptr<SpeechEngine> MakeFliteEngine() { return std::make_unique<FliteEngine>(); }

}  // namespace ssm
