#include "fsm/app/speech_slots.h"

#include "fsm/app/slot_words.h"
#include "vm_protocol/core/start_time.h"

namespace fsm {
namespace {

constexpr const char* kEmptyValue = "non";  // the original's word for an empty value

constexpr SlotWord<Language> kLanguages[] = {
    {"AUTO", Language::kAuto}, {"JP", Language::kJapanese}, {"EN", Language::kEnglish}};

std::string NamesOf(const vm::PhonemeList& list) {
  std::string names;
  for (const vm::Phoneme& phoneme : list) names += (names.empty() ? "" : " ") + phoneme.name;
  return names;
}

std::string LengthOf(const vm::PhonemeList& list) {
  return std::to_string(vm::TotalDuration(list).count());
}

}  // namespace

SpeechSlots::SpeechSlots(FsmCore& core) : core_(core) {
  DeclareListSlots();
  DeclareSpeakSlots();
  DeclareSettings();
}

void SpeechSlots::DeclareListSlots() {
  core_.slots.Declare(
      {.name = "LipSync.pho",
       .grammar = "<text>",
       .initial = kEmptyValue,
       .help = "The phonemes to speak and their ms: `h 80 a 100`, `h[80] a[100]`. "
               "Refused while SPEAKING. non: there are none.",
       .on_set = core_.Command([this](const vm::SetValue& value) { return Prepare(value.text); }),
       .saved = false});
  core_.slots.Declare({.name = "LipSync.dur",
                       .grammar = "<ms>",
                       .access = vm::Access::kReadOnly,
                       .initial = "0",
                       .help = "The duration of LipSync.pho in ms."});
  core_.slots.Declare(
      {.name = "LipSync.text",
       .grammar = "<text>",
       .initial = kEmptyValue,
       .help = "The words of the next LipSync.pho, given before it: greetings, thanks, questions "
               "and the like bring slight looks of the face (Autonomous' TEXT). They count for one "
               "utterance. non: they are not known.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         text_ = value.text == kEmptyValue ? "" : value.text;
         return value.text;
       },
       .saved = false});
  core_.slots.Declare({.name = "LipSync",
                       .grammar = "<text>",
                       .access = vm::Access::kWriteOnly,
                       .help = "Another name to set LipSync.pho by; `inq` lists its parts.",
                       .on_set_later = core_.CommandLater([this](const vm::SetValue& value) {
                         auto stored = Prepare(value.text);
                         if (stored) core_.slots.Report("LipSync.pho", *stored);
                         return stored;
                       }),
                       .group = {"LipSync.pho", "LipSync.dur"}});
}

void SpeechSlots::DeclareSpeakSlots() {
  const auto read_only = [this](const char* name, const char* initial, const char* help) {
    core_.slots.Declare({.name = name,
                         .grammar = "<text>",
                         .access = vm::Access::kReadOnly,
                         .initial = initial,
                         .help = help});
  };
  read_only("Speak.text", kEmptyValue, "The names of the phonemes to speak.");
  read_only("Speak.pho", kEmptyValue, "The phonemes to speak with their ms.");
  read_only("Speak.dur", "0", "Their duration in ms.");
  read_only("Speak.utt", kEmptyValue, "The phonemes spoken before, as far as they were spoken.");
  read_only("Speak.len", "0", "How many ms of them were spoken.");
  read_only("Speak.stat", "IDLE", "IDLE, PROCESSING, READY or SPEAKING.");
  core_.slots.Declare(
      {.name = "Speak",
       .grammar = "NOW | STOP | <time>",
       .access = vm::Access::kWriteOnly,
       .help = "Starts the mouth: NOW, + ms, @T (ms on the module's clock) or a wall "
               "time; given before the list it is remembered. STOP closes the mouth.",
       .on_set_later =
           core_.CommandLater([this](const vm::SetValue& value) { return Speak(value); }),
       .group = {"Speak.text", "Speak.pho", "Speak.dur", "Speak.utt", "Speak.len", "Speak.stat"},
       .told_with_group = {"Speak.syncoffset"}});
  core_.slots.Declare({.name = "Speak.sync",
                       .grammar = "<number 0..86400000>",
                       .access = vm::Access::kWriteOnly,
                       .help = "The voice has played so many ms; the mouth follows without a jump. "
                               "0 is ignored.",
                       .on_set_later = core_.CommandLater([this](const vm::SetValue& value) {
                         if (value.number(0) <= 0) return;
                         core_.motion->speech.Sync(core_.Now(), value.number(0));
                         if (state_ == State::kSpeaking) WaitForEnd();
                       })});
}

void SpeechSlots::DeclareSettings() {
  const auto setting = [this](const char* name, const std::string& grammar, const char* help,
                              const std::string& initial, auto apply,
                              std::string (*told)(const vm::SetValue&) = nullptr) {
    core_.slots.Declare(
        {.name = name,
         .grammar = grammar,
         .initial = initial,
         .help = help,
         .on_set = [this, set = core_.Setting(apply), told](const vm::SetValue& value) {
           auto done = set(value);
           if (state_ == State::kSpeaking) WaitForEnd();
           return done && told != nullptr ? told(value) : done;
         }});
  };
  setting("Speak.syncoffset", "<number -10000..10000>",
          "ms added to what the voice reports in Speak.sync.", "0",
          [](MotionSettings& s, const vm::SetValue& v) { s.sync_offset_ms = v.number(0); });
  setting("Speak.syncrate", "<number 1..90>",
          "How quickly a difference to the voice is worked off: at most so many per cent faster or "
          "slower than time.",
          "25", [](MotionSettings& s, const vm::SetValue& v) { s.sync_rate = v.number(0) / 100; });
  setting(
      "Offset", "<number -10000..10000>", "Delays the mouth by so many ms.", "0.000000",
      [](MotionSettings& s, const vm::SetValue& v) { s.offset_ms = v.number(0); },
      // The format of the original: 100.000000.
      [](const vm::SetValue& value) { return std::to_string(value.number(0)); });
  setting("LipSync.lead", "<number -1000..1000>", "The mouth is ahead of the voice by so many ms.",
          "40", [](MotionSettings& s, const vm::SetValue& v) { s.lead_ms = v.number(0); });
  setting("LipSync.language", GrammarOf(kLanguages),
          "Whose mouth shapes phonemes have; AUTO looks at each list.",
          WordOf(kLanguages, core_.motion->settings().lips.language),
          [](MotionSettings& s, const vm::SetValue& v) {
            s.lips.language = *ValueOf(kLanguages, v.word(0));
          });
  setting("MouthScale", "<number 0..200>",
          "Size of the mouth's movements in the original's per cent: 30 is natural speech, 40 full "
          "articulation.",
          "30", [](MotionSettings& s, const vm::SetValue& v) { s.mouth_scale = v.number(0); });
}

vm::Result<std::string> SpeechSlots::Prepare(const std::string& text) {
  if (state_ == State::kSpeaking) {
    return vm::Fail(vm::Errc::kBusy,
                    "speaking; wait for Speak.stat = IDLE or set Speak = STOP first");
  }
  auto list = vm::ParsePhonemes(text);
  if (!list) return std::unexpected(list.error());
  timer_.Cancel();
  if (core_.motion->speech.active())
    core_.motion->speech.Stop(core_.Now());  // it had not started yet
  list_ = std::move(*list);
  const std::string written = vm::FormatPhonemesFace(list_);
  core_.slots.Store("LipSync.dur", LengthOf(list_));
  core_.slots.Report("Speak.text", NamesOf(list_));
  core_.slots.Report("Speak.pho", written);
  core_.slots.Report("Speak.dur", LengthOf(list_));
  core_.slots.Report("Speak.utt", spoken_.empty() ? kEmptyValue : vm::FormatPhonemesFace(spoken_));
  core_.slots.Report("Speak.len", LengthOf(spoken_));
  SetState(State::kProcessing);
  SetState(State::kReady);
  // Unknown phonemes are reported, but the list is spoken nevertheless, as in the original.
  for (const std::string& name : core_.motion->speech.UnknownPhonemes(list_)) {
    core_.slots.ReportError("LipSync.pho", {vm::Errc::kBadValue,
                                            "the phoneme '" + name +
                                                "' is in no table (LipSync.names); the mouth "
                                                "closes on it",
                                            0});
  }
  if (start_asked_) Begin();
  return written;
}

vm::Result<void> SpeechSlots::Speak(const vm::SetValue& value) {
  if (value.word(0) == "STOP") {
    Stop();
    return {};
  }
  if (state_ == State::kSpeaking) {
    return vm::Fail(vm::Errc::kBusy, "speaking already; set Speak = STOP first");
  }
  const auto start = vm::ParseStartTime(value.text);
  if (!start) return std::unexpected(start.error());
  start_asked_ = true;
  // NOW means as soon as the phonemes have arrived, however late.
  asked_start_.reset();
  if (start->kind != vm::StartTime::Kind::kNow) asked_start_ = core_.InstantOf(*start);
  if (state_ == State::kReady) Begin();
  return {};
}

void SpeechSlots::Begin() {
  const vm::Time now = core_.Now();
  const vm::Time start = asked_start_.value_or(now);
  core_.motion->speech.Start(now, list_, start, std::exchange(text_, {}));
  core_.slots.Store("LipSync.text", kEmptyValue);
  if (start > now) {
    timer_.At(start, core_.Timed([this, start] { TellSpeaking(start); }));
  } else {
    TellSpeaking(start);
  }
}

void SpeechSlots::TellSpeaking(vm::Time start) {
  SetState(State::kSpeaking);
  for (const auto& group : core_.slot_groups) group->OnSpeechBegin(start);
  WaitForEnd();
}

void SpeechSlots::WaitForEnd() {
  const vm::Time end = core_.motion->speech.End().value_or(core_.Now());
  timer_.At(end, core_.Timed([this] {
    // Changed settings may have moved the end.
    if (core_.motion->speech.End().value_or(vm::Time(0)) > core_.Now()) return WaitForEnd();
    EndSpeech(list_);
  }));
}

void SpeechSlots::Stop() {
  timer_.Cancel();
  const vm::Time now = core_.Now();
  vm::PhonemeList spoken;
  if (state_ == State::kSpeaking) {
    const auto heard = static_cast<std::int64_t>(core_.motion->speech.VoicePositionAt(now));
    spoken = vm::SpokenPart(list_, std::chrono::milliseconds(heard));
  }
  core_.motion->speech.Stop(now);
  if (state_ == State::kIdle) {
    start_asked_ = false;
    SetState(State::kIdle);
    return;
  }
  EndSpeech(std::move(spoken));
}

void SpeechSlots::EndSpeech(vm::PhonemeList spoken) {
  spoken_ = std::move(spoken);
  list_.clear();
  start_asked_ = false;
  // As in the original, these are reported with the next list; only IDLE reports the end.
  core_.slots.Store("Speak.len", LengthOf(spoken_));
  core_.slots.Store("Speak.utt", spoken_.empty() ? kEmptyValue : vm::FormatPhonemesFace(spoken_));
  SetState(State::kIdle);
  for (const auto& group : core_.slot_groups) group->OnSpeechEnd();
}

void SpeechSlots::RestoreInitial() {
  timer_.Cancel();
  const bool was_busy = state_ == State::kSpeaking;
  state_ = State::kIdle;
  list_.clear();
  spoken_.clear();
  start_asked_ = false;
  text_.clear();
  if (was_busy) core_.slots.Report("Speak.stat", "IDLE");
}

void SpeechSlots::SetState(State state) {
  static constexpr const char* kNames[] = {"IDLE", "PROCESSING", "READY", "SPEAKING"};
  state_ = state;
  core_.slots.Report("Speak.stat", kNames[static_cast<int>(state)]);
}

}  // namespace fsm
