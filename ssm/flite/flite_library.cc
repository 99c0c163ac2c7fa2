#include "ssm/flite/flite_library.h"

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
#include <memory>
#include <mutex>
#include <string_view>

namespace ssm {
namespace {

constexpr int kChunkFrames = 800;  // 50 ms: the step in which sound comes and can be stopped

struct FliteVoice {
  VoiceInfo info;
  cst_voice* (*register_voice)(const char*);
  cst_voice* voice = nullptr;
  cst_audio_streaming_info* streaming = nullptr;  // owned by the voice's features
};

std::mutex& LibraryMutex() {
  static std::mutex mutex;
  return mutex;
}

std::array<FliteVoice, 4>& Voices() {
  static std::array<FliteVoice, 4> voices = {
      {{{.name = "slt", .language = "en", .female = true}, register_cmu_us_slt},
       // rms models its pitch in a way that takes no shift.
       {{.name = "rms", .language = "en", .pitch_adjustable = false}, register_cmu_us_rms},
       {{.name = "awb", .language = "en"}, register_cmu_us_awb},
       {{.name = "kal16", .language = "en"}, register_cmu_us_kal16}}};
  return voices;
}

Millis Rounded(float seconds) { return Millis(std::lround(static_cast<double>(seconds) * 1000.0)); }

FliteAnalysis ReadSegments(const cst_utterance* utterance) {
  FliteAnalysis analysis;
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

/// One run of the library. Lives as long as it.
struct Run {
  const FliteLibrary::Listener& listener;
  bool analysed = false;
  bool Analyse(const cst_utterance* utterance) {
    if (std::exchange(analysed, true)) return true;
    return listener.analysed(ReadSegments(utterance));
  }
};

int OnSound(const cst_wave* wave, int start, int size, int, cst_audio_streaming_info* info) {
  auto& run = *static_cast<Run*>(info->userdata);
  if (info->utt != nullptr && !run.Analyse(info->utt)) return CST_AUDIO_STREAM_STOP;
  const std::span<const std::int16_t> heard(wave->samples + start, static_cast<std::size_t>(size));
  return run.listener.sound(heard) ? CST_AUDIO_STREAM_CONT : CST_AUDIO_STREAM_STOP;
}

/// The voice, made known to flite.
FliteVoice& Find(std::string_view name) {
  auto& voices = Voices();
  auto found = std::find_if(voices.begin(), voices.end(),
                            [&](const FliteVoice& voice) { return voice.info.name == name; });
  if (found == voices.end()) found = voices.begin();
  if (found->voice == nullptr) {
    found->voice = found->register_voice(nullptr);
    found->streaming = new_audio_streaming_info();
    found->streaming->min_buffsize = kChunkFrames;
    found->streaming->asc = OnSound;
    feat_set(found->voice->features, "streaming_info", audio_streaming_info_val(found->streaming));
  }
  return *found;
}

/// Words of one sentence in the voice's lexicon; taken out again at the end.
class Pronunciations {
 public:
  Pronunciations(const cst_voice* voice, const FliteSentence& sentence)
      : lexicon_(val_lexicon(feat_val(voice->features, "lexicon"))) {
    for (const auto& [word, phones] : sentence.pronunciations) {
      cst_val* entry = cst_lex_make_entry(lexicon_, (word + " : " + phones).c_str());
      if (entry != nullptr) list_ = cons_val(entry, list_);
    }
    before_ = lexicon_->lex_addenda;
    if (list_ != nullptr) lexicon_->lex_addenda = list_;
  }
  ~Pronunciations() {
    lexicon_->lex_addenda = before_;
    delete_val(list_);
  }
  Pronunciations(const Pronunciations&) = delete;

 private:
  cst_lexicon* const lexicon_;
  cst_val* list_ = nullptr;
  cst_val* before_ = nullptr;
};

}  // namespace

FliteLibrary::FliteLibrary() {
  const std::lock_guard lock(LibraryMutex());
  flite_init();
  for (const FliteVoice& voice : Voices()) infos_.push_back(voice.info);
}

bool FliteLibrary::Speak(const FliteSentence& sentence, const Listener& listener) {
  const std::lock_guard lock(LibraryMutex());
  FliteVoice& voice = Find(sentence.voice);
  Run run{listener};
  voice.streaming->userdata = &run;
  voice.streaming->utt = nullptr;
  feat_set_float(voice.voice->features, "duration_stretch", static_cast<float>(sentence.stretch));
  feat_set_float(voice.voice->features, "f0_shift", static_cast<float>(sentence.pitch));
  const Pronunciations pronunciations(voice.voice, sentence);
  const std::unique_ptr<cst_utterance, void (*)(cst_utterance*)> utterance(
      flite_synth_text(sentence.text.c_str(), voice.voice), delete_utterance);
  voice.streaming->userdata = nullptr;
  if (!utterance) return false;
  run.Analyse(utterance.get());  // where no sound came
  return true;
}

}  // namespace ssm
