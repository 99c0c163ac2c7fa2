// The voice module from READY on: speaking, pausing, stopping, and what is told of it.

#include <algorithm>
#include <iterator>
#include <utility>

#include "ssm/voice/voice_module.h"

namespace ssm {

void VoiceModule::SetSpeak(const std::string& text, const vm::Reply& reply) {
  auto start = vm::ParseStartTime(text);
  if (!start) return reply.Fail(start.error());
  // A delay counts from the request, also when the text is not ready yet.
  const vm::Time at = vm::Resolve(*start, scheduler_.Now(), options_.wall_clock());
  if (next_ && std::exchange(next_->spoken, true))
    return reply.Fail({vm::Errc::kBusy, "the next text is to be spoken already", 0});
  if (!PutOff([this, at, text, reply] { Speak(at, text, reply); }, reply)) Speak(at, text, reply);
}

void VoiceModule::Speak(vm::Time at, const std::string& text, const vm::Reply& reply) {
  if (player_.active() && player_.started()) {
    return reply.Fail({vm::Errc::kBusy, "already speaking; wait for Speak.stat = IDLE", 0});
  }
  if (!utterance_) {
    return reply.Fail({vm::Errc::kBusy, "there is nothing to speak; set Text first", 0});
  }
  if (player_.active()) player_.Stop();  // still waiting for its instant: the new one counts
  if (auto playing = StartPlaying(at); !playing) {
    SetState(State::kError);
    Tail(0);
    return reply.Fail(playing.error());
  }
  reply.Ok(text);
}

vm::Result<void> VoiceModule::StartPlaying(vm::Time at, std::size_t from) {
  std::vector<Player::Cue> words, marks, cues;
  const auto& plan = utterance_->plan;
  std::size_t number = 0;
  for (const WordTime& word : plan.words) {
    ++number;
    if (ToFrames(word.start) < from) continue;
    words.push_back(
        {ToFrames(word.start) - from,
         [this, text = std::to_string(number) + " " + std::to_string(word.start.count()) + " " +
                       word.text] { slots_.Report("Speak.word", text); }});
  }
  for (const MarkTime& mark : plan.marks) {
    if (ToFrames(mark.at) < from) continue;
    marks.push_back({ToFrames(mark.at) - from,
                     [this, text = mark.name + " " + std::to_string(mark.at.count())] {
                       slots_.Report("Speak.mark", text);
                     }});
  }
  // Each in order already; at the same frame the mark comes first, as in the text.
  std::merge(marks.begin(), marks.end(), words.begin(), words.end(), std::back_inserter(cues),
             [](const auto& a, const auto& b) { return a.frame < b.frame; });
  spoken_ = utterance_;
  spoken_frames_ = played_before_ = from;
  playing_ = utterance_->samples;
  if (from > 0) {
    const auto rest = utterance_->samples->Ready().subspan(from);
    auto buffer = std::make_shared<SampleBuffer>(rest.size());
    buffer->Append(rest);
    playing_ = std::move(buffer);
  }
  return player_.Start(playing_, at, std::move(cues));
}

/// What was heard, counted from the beginning of the utterance; on the tape already.
AudioSink::Position VoiceModule::StopPlayer() {
  AudioSink::Position end = player_.Stop();
  AddToTape(end);
  end.frames += played_before_;
  return end;
}

void VoiceModule::Pause(const vm::Reply& reply) {
  if (!player_.active() || !player_.started()) {
    return reply.Fail({vm::Errc::kBusy, "not speaking, there is nothing to pause", 0});
  }
  spoken_frames_ = StopPlayer().frames;
  SetState(State::kPaused);
  reply.Ok("PAUSE");
}

void VoiceModule::Resume(const vm::Reply& reply) {
  if (state_ != State::kPaused) {
    return reply.Fail({vm::Errc::kBusy, "not paused; set Speak = PAUSE comes first", 0});
  }
  // What is left is copied, so all of it must be there. (It is made many times faster than heard.)
  if (!utterance_->samples->complete()) {
    waiting_for_sound_.push_back({[this, reply] { Resume(reply); }, reply});
    return;
  }
  if (auto playing = StartPlaying(scheduler_.Now(), spoken_frames_); !playing) {
    SetState(State::kError);
    Tail(spoken_frames_);
    return reply.Fail(playing.error());
  }
  reply.Ok("RESUME");
}

void VoiceModule::Stop() {
  Abandon(waiting_, "set Speak = STOP came first");
  DropNext("set Speak = STOP came first");
  if (state_ == State::kProcessing) {
    *preparation_->cancelled = true;
    preparation_->reply.Fail({vm::Errc::kStopped, "set Speak = STOP came first", 0});
    preparation_.reset();
    spoken_.reset();
    return Tail(0);
  }
  if (player_.active()) {
    return Tail(StopPlayer().frames);
  }
  if (state_ == State::kPaused) return Tail(spoken_frames_);
  if (state_ == State::kReady) {
    spoken_ = utterance_;
    return Tail(0);
  }
  // Nothing was going on. Whoever waits for IDLE gets it; what was said last stays known.
  SetState(State::kIdle);
}

void VoiceModule::OnEnded(AudioSink::Position end, bool failed) {
  AddToTape(end);
  end.frames += played_before_;
  if (failed) {
    SetState(State::kError);
    Fault("Speak", {vm::Errc::kUnavailable, "the sound device '" + sink_->name() + "' failed", 0});
  }
  Tail(end.frames);
  TakeTurns();
  TakeNext();
}

void VoiceModule::Tail(std::size_t frames) {
  spoken_frames_ = frames;
  slots_.Report("Speak.len", slots_.Value("Speak.len"));
  slots_.Report("Speak.utt", slots_.Value("Speak.utt"));
  SetState(State::kIdle);
}

Millis VoiceModule::Spoken() const {
  return ToMs(player_.active() ? played_before_ + player_.Where().frames : spoken_frames_);
}

}  // namespace ssm
