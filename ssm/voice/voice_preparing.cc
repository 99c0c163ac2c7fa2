// The voice module from Text to READY: markup, the engine's plan, its sound.

#include <algorithm>
#include <utility>

#include "ssm/voice/emoji.h"
#include "ssm/voice/lead.h"
#include "ssm/voice/prosody.h"
#include "ssm/voice/ssml.h"
#include "ssm/voice/voice_module.h"
#include "ssm/voice/wav_file.h"
#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/text_file.h"

namespace ssm {
namespace {

// Room for "rep#TAG Speak.pho = " and the hub's "From @SSM " within one line.
constexpr std::size_t kMaxPhonemeText = vm::kMaxLineBytes - 1024;
constexpr std::size_t kMaxLexiconBytes = std::size_t{4} << 20;
constexpr std::size_t kMostNotes = 200;

vm::Result<void> CheckSize(const SpeechPlan& plan) {
  if (plan.phonemes.size() <= vm::kMaxPhonemes &&
      vm::FormatPhonemesVoice(plan.phonemes).size() <= kMaxPhonemeText) {
    return {};
  }
  return vm::Fail(vm::Errc::kLimit, "the text makes " + std::to_string(plan.phonemes.size()) +
                                        " phonemes, more than one line can tell; divide it");
}

/// Whether there is anything to say, to mark or to wait for.
bool IsBlank(const std::vector<SpeechSpan>& spans) {
  return std::all_of(spans.begin(), spans.end(), [](const SpeechSpan& span) {
    return span.text.find_first_not_of(" \t\r\n") == std::string::npos && span.mark.empty() &&
           span.audio.empty() && span.pause_before.count() == 0;
  });
}

}  // namespace

vm::Error VoiceModule::TooLong(const std::string& text) {
  return {vm::Errc::kTooLong,
          "the text has " + std::to_string(text.size()) + " bytes, expected at most " +
              std::to_string(kMaxTextBytes),
          0};
}

void VoiceModule::SetText(const std::string& text, const vm::Reply& reply) {
  if (text.size() > kMaxTextBytes) return reply.Fail(TooLong(text));
  if (state_ == State::kPaused || player_.active()) return SetNext(text, reply);
  if (TakesNext(text, reply)) return;
  // A sound still wanted by a SaveWAV is made to the end first.
  if (MustWait() || !waiting_for_sound_.empty()) {
    return WaitTurn([this, text, reply] { SetText(text, reply); }, reply);
  }
  Prepare(text, reply);
}

void VoiceModule::Prepare(const std::string& text, const vm::Reply& reply,
                          std::shared_ptr<const Prosody> prosody) {
  DropNext("another Text came first");
  if (utterance_) utterance_->samples->Cancel();
  utterance_.reset();
  SetState(State::kProcessing);
  auto read = ReadText(text);
  if (!read) {
    SetState(State::kError);
    reply.Fail(read.error());
    return TakeTurns();
  }
  TaggedText tagged = std::move(*read);
  slots_.Store("Text", text);
  slots_.Report("Text.text", text);
  slots_.Report("Speak.text", tagged.plain);
  log_.Write("text", text);
  log_.Write("arrangedText", tagged.plain);

  auto utterance =
      std::make_shared<Utterance>(Utterance{.text = text, .spoken_text = std::move(tagged.plain)});
  auto preparation = std::make_shared<Preparation>(
      Preparation{.utterance = std::move(utterance),
                  .spans = Manners(std::move(tagged.spans)),
                  .cancelled = std::make_shared<std::atomic<bool>>(false),
                  .reply = reply,
                  .prosody = std::move(prosody)});
  preparation_ = preparation;

  auto job = [this, preparation] {
    preparation->plan = engine_->Plan(preparation->spans, *preparation->cancelled);
  };
  const bool prompt = text.size() <= kPromptTextBytes && engine_->Prompt(preparation->spans);
  if (worker_->immediate() || prompt) {
    job();
    return OnPlanned(preparation);
  }
  worker_->Run(std::move(job), [this, preparation, alive = std::weak_ptr<bool>(alive_)] {
    if (!alive.expired()) OnPlanned(preparation);
  });
}

vm::Result<TaggedText> VoiceModule::ReadText(const std::string& text) {
  auto read = ReadMarkup(
      text, {.language = voice_.language,
             .speaks = [this](const std::string& language) { return engine_->Speaks(language); },
             .is_sound = IsSoundFile,
             .read_file =
                 [](const std::string& path) { return vm::ReadTextFile(path, kMaxLexiconBytes); }});
  if (!read) return read;
  for (const std::string& note : read->notes) {
    if (noted_.size() < kMostNotes && noted_.insert(note).second) {
      Fault("Text", {vm::Errc::kUnavailable, note, 0});
    }
  }
  return read;
}

/// The speaker a span asks for: the first known of its names, else one of its gender, if possible
/// of its language; else the present one.
const VoiceInfo& VoiceModule::SpeakerOf(const SpeechSpan& span) {
  for (std::string_view names = span.voice; !names.empty();) {
    const std::string_view name = names.substr(0, names.find(' '));
    names.remove_prefix(std::min(name.size() + 1, names.size()));
    if (const VoiceInfo* voice = speakers_.Find(name)) return *voice;
  }
  if (const VoiceInfo* whole = speakers_.Find(span.voice)) return *whole;
  if (!span.voice.empty()) {
    Fault("Text",
          {vm::Errc::kBadValue,
           "unknown speaker '" + span.voice + "' in a VOICE tag, the present one goes on", 0});
    return voice_;
  }
  if (span.gender.empty()) return voice_;
  const std::string language = span.language.empty()
                                   ? voice_.language
                                   : span.language.substr(0, span.language.find_first_of("-_"));
  const bool female = span.gender == "female";
  const VoiceInfo* found = nullptr;
  for (const VoiceInfo& voice : engine_->voices()) {
    if (voice.female != female || !voice.listed) continue;
    if (voice.language == language) return voice.name == voice_.name ? voice_ : voice;
    if (found == nullptr) found = &voice;
  }
  return found != nullptr && span.language.empty() && voice_.female != female ? *found : voice_;
}

std::vector<SpeechSpan> VoiceModule::Manners(std::vector<SpeechSpan> spans) {
  for (SpeechSpan& span : spans) {
    const VoiceInfo* voice = &SpeakerOf(span);
    span.voice = voice->name;
    span.text = WithoutEmoji(span.text);
    span.feeling = feeling_;
    Manner& manner = span.feeling.manner;
    if (!voice->pitch_adjustable) manner.pitch = 1;
    span.stretch = std::clamp(span.stretch / (rate_ * manner.rate), 0.1, 10.0);
    span.pitch = std::clamp(span.pitch * pitch_ * manner.pitch, 0.25, 4.0);
    span.volume *= volume_ * manner.volume;
  }
  return spans;
}

void VoiceModule::OnPlanned(const std::shared_ptr<Preparation>& preparation) {
  if (preparation != preparation_) return;  // stopped meanwhile; the reply has been given
  const vm::Reply reply = preparation->reply;
  const auto utterance = preparation->utterance;
  vm::Result<void> outcome;
  if (!preparation->plan) {
    outcome = std::unexpected(preparation->plan.error());
  } else {
    preparation->engine_plan = *preparation->plan;
    if (preparation->prosody) {
      preparation->plan = Retimed(preparation->engine_plan, *preparation->prosody);
    }
    outcome = preparation->plan ? CheckSize(*preparation->plan)
                                : std::unexpected(preparation->plan.error());
  }
  if (!outcome) {
    preparation_.reset();
    SetState(State::kError);
    reply.Fail(outcome.error());
    return TakeTurns();
  }
  utterance->plan = std::move(*preparation->plan);
  const Millis cut = LeadToCut(*preparation, utterance->plan);
  utterance->samples =
      std::make_shared<SampleBuffer>(ToFrames(utterance->duration()), ToFrames(cut));
  utterance_ = utterance;
  ReportPhonemes();
  const bool emoji_only = WithoutEmoji(utterance->spoken_text) != utterance->spoken_text;
  if (utterance->plan.unspoken.empty() && IsBlank(preparation->spans) && !emoji_only) {
    utterance->plan.unspoken = "the text is empty, there is nothing to say";
  }
  if (!utterance->plan.unspoken.empty()) {
    Fault("Text", {vm::Errc::kUnavailable, utterance->plan.unspoken, 0});
  }

  auto result = std::make_shared<vm::Result<void>>();
  worker_->Run([this, preparation, utterance, result] { *result = Render(*preparation); },
               [this, utterance, result, alive = std::weak_ptr<bool>(alive_)] {
                 if (!alive.expired()) OnRendered(utterance, *result);
               });
  if (utterance_ != utterance) {  // the sound could not be made, and that is known already
    preparation_.reset();
    reply.Fail(result->error());
    return TakeTurns();
  }
  MakeReady(reply, utterance->text);
}

/// Cuts the silence before the first sound as Text.lead says, but neither a pause that was asked
/// for nor that between two texts.
Millis VoiceModule::LeadToCut(const Preparation& preparation, SpeechPlan& plan) const {
  const std::string lead = slots_.Value("Text.lead");
  const bool asked_for =
      !preparation.spans.empty() && (preparation.spans.front().pause_before > Millis(0) ||
                                     !preparation.spans.front().audio.empty());
  const bool follows = !preparation.wanted.empty();
  if (lead == "NATURAL" || asked_for || follows || preparation.prosody) return Millis(0);
  return CutLead(plan, Millis(std::stol(lead)));
}

vm::Result<void> VoiceModule::Render(const Preparation& preparation) {
  SampleBuffer& samples = *preparation.utterance->samples;
  const SpeechPlan& plan = preparation.engine_plan;
  if (!preparation.prosody) return engine_->Render(plan, samples);
  SampleBuffer own(ToFrames(vm::TotalDuration(plan.phonemes)));
  if (auto made = engine_->Render(plan, own); !made) return made;
  Reshape({own.Ready().begin(), own.Ready().end()}, plan, *preparation.prosody, samples);
  return {};
}

void VoiceModule::ReportPhonemes() {
  const std::string phonemes = vm::FormatPhonemesVoice(utterance_->plan.phonemes);
  const std::string duration = std::to_string(utterance_->duration().count());
  log_.Write("phoneme", phonemes);
  slots_.Report("Text.pho", phonemes);
  slots_.Report("Speak.pho", phonemes);
  slots_.Report("Text.dur", duration);
  slots_.Report("Speak.dur", duration);
}

void VoiceModule::MakeReady(const vm::Reply& reply, std::string answer) {
  preparation_.reset();
  if (auto_play_) {
    // As the original: SPEAKING is said first, READY after it, though it is speaking.
    const auto delay = std::stol(slots_.Value("AutoPlayDelay"));
    SetState(State::kSpeaking);
    slots_.Report("Speak.stat", "READY");
    slots_.Store("Speak.stat", "SPEAKING");
    if (auto playing = StartPlaying(scheduler_.Now() + Millis(delay)); !playing) {
      SetState(State::kError);
      Tail(0);
      reply.Fail(playing.error());
      return TakeTurns();
    }
  } else {
    SetState(State::kReady);
  }
  reply.Ok(std::move(answer));
  TakeTurns();
}

void VoiceModule::OnRendered(const std::shared_ptr<Utterance>& utterance,
                             const vm::Result<void>& result) {
  if (utterance != utterance_) return;  // given up for another text
  if (result) {
    log_.Write("sentence", utterance->spoken_text);
    for (auto queue = std::exchange(waiting_for_sound_, {}); !queue.empty(); queue.pop_front()) {
      queue.front().action();
    }
    return TakeTurns();
  }
  Abandon(waiting_for_sound_, "the sound could not be made");
  utterance_.reset();
  if (player_.active()) {
    spoken_ = utterance;
    const AudioSink::Position end = StopPlayer();
    SetState(State::kError);
    Tail(end.frames);
  } else {
    SetState(State::kError);
  }
  // While the text is still being prepared, the answer to its request says it.
  if (!preparation_) Fault("Text", result.error());
}

}  // namespace ssm
