#include "ssm/voice/voice_module.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

#include "ssm/voice/ssml.h"
#include "vm_protocol/core/limits.h"

namespace ssm {
namespace {

// Room for "rep#TAG Speak.pho = " and the hub's "From @SSM " within one line.
constexpr std::size_t kMaxPhonemeText = vm::kMaxLineBytes - 1024;

vm::Result<void> CheckSize(const SpeechPlan& plan) {
  if (plan.phonemes.size() <= vm::kMaxPhonemes &&
      vm::FormatPhonemesVoice(plan.phonemes).size() <= kMaxPhonemeText) {
    return {};
  }
  return vm::Fail(vm::Errc::kLimit, "the text makes " + std::to_string(plan.phonemes.size()) +
                                        " phonemes, more than one line can tell; divide it");
}

}  // namespace

VoiceModule::VoiceModule(vm::Scheduler& scheduler, Parts parts, Options options)
    : scheduler_(scheduler),
      options_(std::move(options)),
      slots_("SSM"),
      engine_(std::move(parts.engine)),
      sink_(std::move(parts.sink)),
      worker_(std::move(parts.worker)),
      player_(scheduler, *sink_,
              {.started = [this] { SetState(State::kSpeaking); },
               .sync =
                   [this](std::size_t frames) {
                     slots_.TellAll("Speak.sync = " +
                                    std::to_string(ToMs(played_before_ + frames).count()));
                   },
               .ended = [this](AudioSink::Position end, bool failed) { OnEnded(end, failed); }}),
      speakers_(engine_->voices(), options_.aliases),
      voice_(engine_->voices().front()),
      auto_play_(options_.auto_play) {
  if (const VoiceInfo* wanted = speakers_.Find(options_.speaker)) voice_ = *wanted;
  vm::DeclareCommonSlots(slots_, {.module_version = options_.module_version,
                                  .protocol_version = "Protocol Ver. 1.0",
                                  .quoted_versions = true,
                                  .auto_output = true,
                                  .on_exit = [this] { exit_requested_ = true; }});
  DeclareManner();
  DeclareEmotion();
  DeclareTextSlots();
  DeclareSpeakSlots();
  DeclareFileSlots();
  DeclareLogSlots();
  slots_.AddShortcut("o", "set Speak = NOW");
  player_.set_sync_interval(ToFrames(Millis(1000)));
}

VoiceModule::~VoiceModule() {
  *alive_ = false;
  if (preparation_) *preparation_->cancelled = true;
  if (next_) *next_->cancelled = true;
  if (utterance_) utterance_->samples->Cancel();
  worker_.reset();
}

bool VoiceModule::Busy() const {
  return state_ == State::kProcessing || player_.active() || !waiting_.empty() ||
         !waiting_for_sound_.empty();
}

void VoiceModule::Shutdown() {
  if (player_.active()) {
    StopPlayer();
  }
  if (tape_) {
    if (auto closed = tape_->Close(scheduler_.Now()); !closed) Fault("Record", closed.error());
    tape_.reset();
  }
}

// --- preparing a text

void VoiceModule::SetText(const std::string& text, const vm::Reply& reply) {
  if (text.size() > kMaxTextBytes) {
    return reply.Fail({vm::Errc::kTooLong,
                       "the text has " + std::to_string(text.size()) + " bytes, expected at most " +
                           std::to_string(kMaxTextBytes),
                       0});
  }
  if (state_ == State::kPaused) {
    return reply.Fail({vm::Errc::kBusy, "paused; set Speak = RESUME or STOP first", 0});
  }
  if (player_.active()) {
    return reply.Fail({vm::Errc::kBusy,
                       std::string(player_.started() ? "speaking" : "about to speak") +
                           "; wait for Speak.stat = IDLE or set Speak = STOP",
                       0});
  }
  // A sound still wanted by a SaveWAV is made to the end first.
  if (MustWait() || !waiting_for_sound_.empty()) {
    return WaitTurn([this, text, reply] { SetText(text, reply); }, reply);
  }
  Prepare(text, reply);
}

void VoiceModule::Prepare(const std::string& text, const vm::Reply& reply) {
  DropNext("another Text came first");
  if (utterance_) utterance_->samples->Cancel();
  utterance_.reset();
  SetState(State::kProcessing);
  auto read = ReadMarkup(text);
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
                  .reply = reply});
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

std::vector<SpeechSpan> VoiceModule::Manners(std::vector<SpeechSpan> spans) {
  for (SpeechSpan& span : spans) {
    const VoiceInfo* voice = span.voice.empty() ? &voice_ : speakers_.Find(span.voice);
    if (voice == nullptr) {
      Fault("Text",
            {vm::Errc::kBadValue,
             "unknown speaker '" + span.voice + "' in a VOICE tag, the present one goes on", 0});
      voice = &voice_;
    }
    span.voice = voice->name;
    const double pitch = voice->pitch_adjustable ? emotion_.pitch : 1;
    span.stretch = std::clamp(span.stretch / (rate_ * emotion_.rate), 0.1, 10.0);
    span.pitch = std::clamp(span.pitch * pitch_ * pitch, 0.25, 4.0);
    span.volume *= volume_ * emotion_.volume;
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
    outcome = CheckSize(*preparation->plan);
  }
  if (!outcome) {
    preparation_.reset();
    SetState(State::kError);
    reply.Fail(outcome.error());
    return TakeTurns();
  }
  utterance->plan = std::move(*preparation->plan);
  utterance->samples = std::make_shared<SampleBuffer>(ToFrames(utterance->duration()));
  utterance_ = utterance;
  ReportPhonemes();
  if (!utterance->plan.unspoken.empty()) {
    Fault("Text", {vm::Errc::kUnavailable, utterance->plan.unspoken, 0});
  }

  auto result = std::make_shared<vm::Result<void>>();
  worker_->Run([this, utterance,
                result] { *result = engine_->Render(utterance->plan, *utterance->samples); },
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

// --- common

void VoiceModule::SetState(State state) {
  static constexpr const char* kNames[] = {"IDLE",     "PROCESSING", "READY",
                                           "SPEAKING", "ERROR",      "PAUSED"};
  // AutoPlay has said SPEAKING already when the first sound is due.
  const bool said = state == State::kSpeaking && state_ == State::kSpeaking;
  state_ = state;
  if (!said) slots_.Report("Speak.stat", kNames[static_cast<std::size_t>(state)]);
}

void VoiceModule::Fault(std::string_view slot, const vm::Error& error) {
  slots_.ReportError(slot, error);
}

void VoiceModule::WaitTurn(std::function<void()> action, const vm::Reply& reply) {
  if (waiting_.size() >= kMaxWaiting) {
    return reply.Fail({vm::Errc::kLimit,
                       "more than " + std::to_string(kMaxWaiting) + " requests wait for the text",
                       0});
  }
  waiting_.push_back({std::move(action), reply});
}

void VoiceModule::TakeTurns() {
  if (state_ == State::kProcessing || !waiting_for_sound_.empty()) return;
  // Each may put the next ones off again; those that stay keep their order.
  auto queue = std::exchange(waiting_, {});
  while (!queue.empty()) {
    const Waiting next = std::move(queue.front());
    queue.pop_front();
    next.action();
    if (MustWait() || !waiting_for_sound_.empty()) break;
  }
  // What was put off by the last action goes before the rest.
  for (Waiting& left : queue) waiting_.push_back(std::move(left));
}

void VoiceModule::Abandon(std::deque<Waiting>& queue, const char* why) {
  for (auto given_up = std::exchange(queue, {}); !given_up.empty(); given_up.pop_front()) {
    given_up.front().reply.Fail({vm::Errc::kStopped, why, 0});
  }
}

}  // namespace ssm
