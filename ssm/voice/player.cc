#include "ssm/voice/player.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ssm {
namespace {

// A device that does not move is asked again this often. (On the clock sink every estimate is
// exact, and this is never used.)
constexpr vm::Time kAskAgain{1000};

}  // namespace

Player::Player(vm::Scheduler& scheduler, AudioSink& sink, Events events)
    : scheduler_(scheduler), sink_(sink), events_(std::move(events)) {}

Player::~Player() {
  if (active()) Stop();
}

vm::Result<void> Player::Start(std::shared_ptr<const SampleBuffer> samples, vm::Time start,
                               std::vector<Cue> cues) {
  assert(!active());
  start_ = std::max(start, scheduler_.Now());
  if (auto played = sink_.Play(samples, start_); !played) return played;
  samples_ = std::move(samples);
  cues_ = std::move(cues);
  next_cue_ = 0;
  next_sync_ = sync_interval_;
  ++run_;
  if (start_ <= scheduler_.Now()) {
    Begin();
  } else {
    timer_ = scheduler_.At(start_, [this] { Begin(); });
  }
  return {};
}

void Player::Begin() {
  timer_ = 0;
  started_ = true;
  const std::size_t run = run_;
  if (events_.started) events_.started();
  if (active() && run == run_) Arm();
}

void Player::set_sync_interval(std::size_t frames) {
  sync_interval_ = frames;
  if (!active()) return;
  // The next tick is the next multiple of the new interval beyond what was heard.
  next_sync_ = frames == 0 ? 0 : (sink_.Where().frames / frames + 1) * frames;
  if (started_) Arm();
}

std::size_t Player::NextFrame() const {
  std::size_t next = samples_->size();
  if (sync_interval_ > 0) next = std::min(next, next_sync_);
  if (next_cue_ < cues_.size()) next = std::min(next, cues_[next_cue_].frame);
  return next;
}

void Player::Arm() {
  if (timer_ != 0) scheduler_.Cancel(timer_);
  const AudioSink::Position where = sink_.Where();
  const std::size_t next = NextFrame();
  const vm::Time now = scheduler_.Now();
  // Counting from the first frame avoids adding up roundings; a late device is asked again.
  vm::Time when = where.first_frame + ToTime(next);
  if (next > where.frames && when <= now) when = now + kAskAgain;
  timer_ = scheduler_.At(std::max(when, now), [this] { Step(); });
}

void Player::Step() {
  timer_ = 0;
  const std::size_t run = run_;
  const AudioSink::Position where = sink_.Where();
  while (active() && run == run_ && next_cue_ < cues_.size() &&
         cues_[next_cue_].frame <= where.frames) {
    cues_[next_cue_++].action();
  }
  if (!active() || run != run_) return;
  if (sync_interval_ > 0 && next_sync_ <= where.frames) {
    while (next_sync_ <= where.frames) next_sync_ += sync_interval_;
    // At the very end the end itself says it.
    if (where.frames < samples_->size() && events_.sync) events_.sync(where.frames);
    if (!active() || run != run_) return;
  }
  if (where.failed || where.frames >= samples_->size()) {
    const AudioSink::Position end = Finish();
    if (events_.ended) events_.ended(end, where.failed);
    return;
  }
  Arm();
}

AudioSink::Position Player::Stop() {
  assert(active());
  return Finish();
}

AudioSink::Position Player::Finish() {
  if (timer_ != 0) scheduler_.Cancel(std::exchange(timer_, 0));
  const AudioSink::Position end = sink_.Stop();
  samples_.reset();
  cues_.clear();
  started_ = false;
  return end;
}

}  // namespace ssm
