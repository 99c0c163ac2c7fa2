#include "vdm/core/movement_module.h"

#include <fmt/format.h>

#include <utility>

namespace vdm {

MovementModule::MovementModule(vm::Scheduler& scheduler, Options options)
    : scheduler_(scheduler),
      options_(std::move(options)),
      slots_("VDM"),
      session_(scheduler, slots_, options_.clock_is_shared),
      sender_({.start =
                   [this](vm::Time at) {
                     start_ = at;
                     TellFace("MouthFrame.start", session_.StartText(at));
                   },
               .frame = [this](double ms, const MouthFrame& frame,
                               const std::optional<HeadPose>& head) { TellFrame(ms, frame, head); },
               .moving =
                   [this](bool moving) {
                     slots_.Report("Mouth.stat", moving ? "MOVING" : on_ ? "LISTENING" : "OFF");
                   }}),
      mode_(BestMode()),
      speakers_(options_.speakers_folder) {
  slots_.set_on_heard([this](const vm::Message& message) { session_.Hear(message); });
  DeclareRun();
  DeclareInput();
  DeclareMouth();
  DeclareHead();
  DeclareEmotion();
  DeclareSpeaker();
  Renew();
}

MovementModule::~MovementModule() { Shutdown(); }

void MovementModule::Shutdown() {
  for (vm::TimerId* timer : {&over_timer_, &stall_timer_, &end_timer_}) {
    if (*timer != 0) scheduler_.Cancel(std::exchange(*timer, 0));
  }
  session_.Stop();
  source_.reset();
  sender_.Finish();
}

bool MovementModule::Busy() const {
  return (on_ && source_ && source_->Ends()) || sender_.moving() || end_timer_ != 0;
}

vm::Time MovementModule::ShortestDelay() const {
  // Sound comes in pieces of 20 ms; the face needs the frame after an instant to go towards.
  const auto samples = static_cast<std::int64_t>(tracker_->ahead_samples());
  return vm::Time(samples * 1000 / 16) + sound::RecordedSource::kStep + MouthSender::kEvery;
}

void MovementModule::Renew(bool same_speaker) {
  VoiceManner::Parts parts{.head = head_net_,
                           .emotions = emotion_on_ ? options_.emotions : nullptr,
                           .seed = ++renewals_};
  if (manner_) {
    FinishWaiting();
    if (same_speaker) parts.usual = manner_->stream().usual();
    if (!manner_->emotions().empty()) slots_.Report("Emotion", "NONE");
    TellMood("NEUTRAL", 0);
  }
  sender_.Finish();
  tracker_ = std::make_unique<MouthTracker>(net(), speaker_.warp,
                                            mode_ == Mode::kWords ? options_.words : nullptr);
  words_ = {};
  manner_.reset();
  if (parts.head || parts.emotions) {
    manner_ =
        std::make_unique<VoiceManner>(parts, tracker_->ahead_samples(), tracker_->hop_samples());
  }
  sound_clock_ = {};
}

// --- the source

vm::Result<std::string> MovementModule::SetInput(const std::string& name) {
  source_.reset();
  source_name_ = "NONE";
  Renew();
  if (name == "NONE") return name;
  auto source = options_.open_source(name);
  if (!source) return std::unexpected(source.error());
  source_ = std::move(*source);
  source_name_ = name;
  if (on_) {
    if (auto started = StartSource(); !started) {
      source_.reset();
      source_name_ = "NONE";
      return std::unexpected(started.error());
    }
  }
  return name;
}

void MovementModule::ReadWords() {
  constexpr std::string_view kRecording = "wav:";
  if (!best_ || !options_.read_words || !options_.clock_is_shared()) return;
  if (!source_name_.starts_with(kRecording)) return;
  words_ = options_.read_words(source_name_.substr(kRecording.size()));
  slots_.Report("Mouth.words", words_.text);
}

vm::Result<void> MovementModule::StartSource() {
  stalled_ = false;
  ReadWords();
  return source_->Start({.sound = [this](std::span<const std::int16_t> samples) { Hear(samples); },
                         .ended = [this] { OnSourceOver(); },
                         .failed =
                             [this](const vm::Error& error) {
                               slots_.ReportError("Input", error);
                               OnSourceOver();
                             }});
}

void MovementModule::Start() {
  if (std::exchange(on_, true)) return;
  session_.Start();
  slots_.Report("Mouth.stat", "LISTENING");
  if (!source_) return;
  if (auto started = StartSource(); !started) slots_.ReportError("Input", started.error());
}

void MovementModule::Stop() {
  if (!std::exchange(on_, false)) return;
  session_.Stop();
  if (stall_timer_ != 0) scheduler_.Cancel(std::exchange(stall_timer_, 0));
  if (over_timer_ != 0) scheduler_.Cancel(std::exchange(over_timer_, 0));
  source_.reset();
  // A live source is opened again, for the next START; a recording is over.
  if (source_name_ != "NONE" && !source_name_.starts_with("wav:")) {
    if (auto again = options_.open_source(source_name_)) source_ = std::move(*again);
  }
  if (!source_) source_name_ = "NONE";
  const bool moved = sender_.moving();
  Renew();
  if (moved) TellFace("MouthFrame.start", "STOP");
  slots_.Report("Mouth.stat", "OFF");
}

/// The source may be in the middle of a call, so it goes a little later.
void MovementModule::OnSourceOver() {
  over_timer_ = scheduler_.Post([this] {
    over_timer_ = 0;
    if (stall_timer_ != 0) scheduler_.Cancel(std::exchange(stall_timer_, 0));
    source_.reset();
    source_name_ = "NONE";
    Renew();
    if (learner_) Learned(learner_->Finish());
    slots_.Report("Input", "NONE");
  });
}

void MovementModule::WatchForStall() {
  stall_timer_ = 0;
  const vm::Time quiet = scheduler_.Now() - heard_;
  if (quiet < kStalled) {
    stall_timer_ = scheduler_.After(kStalled - quiet, [this] { WatchForStall(); });
    return;
  }
  stalled_ = true;
  FinishWaiting();
  sender_.Finish();
  slots_.ReportError("Input", {vm::Errc::kTimeout,
                               fmt::format("no sound has come from '{}' for {} ms; the mouth rests "
                                           "until some comes",
                                           source_name_, kStalled.count() / 1000),
                               0});
}

// --- sound to mouth

void MovementModule::Hear(std::span<const std::int16_t> samples) {
  const vm::Time now = scheduler_.Now();
  heard_ = now;
  if (!source_->Ends() && stall_timer_ == 0) {
    stalled_ = false;
    stall_timer_ = scheduler_.After(kStalled, [this] { WatchForStall(); });
  }
  if (mode_ == Mode::kOff) return;
  const bool hole = sound_clock_.End().has_value();
  if (sound_clock_.Add(now, samples.size()) == SoundClock::Places::kBeginAnew && hole) {
    const SoundClock clock = sound_clock_;
    Renew(true);
    sound_clock_ = clock;
  }
  if (manner_) manner_->Add(samples);
  manner_settings_.wait = static_cast<std::size_t>((delay_ - ShortestDelay()).count()) * 16 / 1000;
  for (MouthTracker::Moment& moment : tracker_->Add(samples)) {
    words_.Blend(moment.sample, moment.frame);
    if (!manner_) {
      Show(moment, std::nullopt);
      continue;
    }
    manner_->Take(std::move(moment), manner_settings_,
                  [this](const auto& due, const auto& head) { Show(due, head); });
    TellEmotion();
  }
  if (!learner_) return;
  if (const auto met = learner_->Add(samples)) Learned(*met);
}

void MovementModule::FinishWaiting() {
  if (!manner_) return;
  manner_->Finish([this](const auto& moment, const auto& head) { Show(moment, head); });
}

void MovementModule::Show(const MouthTracker::Moment& moment, const std::optional<HeadPose>& head) {
  sender_.Add(sound_clock_.TimeOf(moment.sample) + delay_, moment.frame, head);
}

void MovementModule::TellFace(std::string slot, std::string value) {
  if (face_ == "NONE") return;
  slots_.Say(vm::To(face_, vm::Set(std::move(slot), std::move(value))));
}

void MovementModule::TellFrame(double ms, const MouthFrame& frame,
                               const std::optional<HeadPose>& head) {
  TellFace("MouthFrame", FrameText(ms, frame, head));
  const vm::Time at = start_ + vm::Time(static_cast<vm::Time::rep>(ms * 1000));
  if (slots_.AutoOutput("Mouth")) {
    slots_.Report("Mouth", FrameText(static_cast<double>(at.count()) / 1000, frame));
  }
  TellProsody(at);
  if (slots_.AutoOutput("Mouth.sounds") && !frame.sounds.empty()) {
    std::string text = vm::FormatMs(at);
    for (std::size_t i = 0; i < frame.sounds.size(); ++i) {
      if (frame.sounds[i] < 0.05F) continue;
      text += fmt::format(" {} {:.2f}", net().sounds[i], frame.sounds[i]);
    }
    slots_.Report("Mouth.sounds", text);
  }
  // Whoever waits until nothing goes on waits until the face has shown it.
  if (at <= scheduler_.Now()) return;
  if (end_timer_ != 0) scheduler_.Cancel(end_timer_);
  end_timer_ = scheduler_.At(at, [this] { end_timer_ = 0; });
}

}  // namespace vdm
