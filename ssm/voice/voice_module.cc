#include "ssm/voice/voice_module.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "ssm/voice/layered_engine.h"

namespace ssm {
VoiceModule::VoiceModule(vm::Scheduler& scheduler, Parts parts, Options options)
    : scheduler_(scheduler),
      options_(std::move(options)),
      slots_("SSM"),
      engine_(std::make_unique<LayeredEngine>(std::move(parts.engine))),
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
  if (!options_.speaker.empty()) {
    const auto wanted = speakers_.Wanted(options_.speaker);
    if (!wanted) throw std::runtime_error("--speaker: " + wanted.error().text);
    voice_ = **wanted;
  }
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
         !waiting_for_sound_.empty() || (next_ && !next_->after.empty());
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

bool VoiceModule::PutOff(const std::function<void()>& action, const vm::Reply& reply) {
  if (!next_ && !MustWait()) return false;
  if (!next_) {
    WaitTurn(action, reply);
  } else if (next_->after.size() < kMaxWaiting) {
    next_->after.push_back({action, reply});
  } else {
    reply.Fail({vm::Errc::kLimit,
                "more than " + std::to_string(kMaxWaiting) + " requests wait for the next text",
                0});
  }
  return true;
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
