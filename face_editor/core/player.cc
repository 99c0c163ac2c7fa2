#include "face_editor/core/player.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace editor {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kLead = 150ms;   // before anything happens
constexpr vm::Time kHold = 900ms;   // an expression stands
constexpr vm::Time kPause = 500ms;  // before the next round

}  // namespace

vm::Result<void> Player::Start(const Show& show, bool loop, vm::Time now) {
  const Show before = std::exchange(show_, show);
  auto old = std::exchange(motion_, nullptr);
  if (show.empty()) return {};
  if (auto planned = Plan(); !planned) {
    show_ = before;
    motion_ = std::move(old);
    return planned;
  }
  loop_ = loop;
  start_ = now;
  return {};
}

std::unique_ptr<fsm::FaceMotion> Player::Fresh() const {
  auto motion = std::make_unique<fsm::FaceMotion>(editor_.Tables(), 1);
  fsm::MotionSettings settings;
  settings.gaze_distance_mm = 0;
  settings.onset = show_.elicited ? fsm::Onset::kElicited : fsm::Onset::kPosed;
  settings.mouth_scale = fsm::kFullMouthScale;
  motion->Apply(0ms, settings);
  return motion;
}

vm::Result<void> Player::Plan() {
  const auto trial = Fresh();
  std::vector<Cue> cues;
  const auto cue = [&](vm::Time at, Command command) {
    auto done = command(*trial);
    if (done) cues.push_back({at, std::move(command)});
    return done;
  };
  vm::Time settled = kLead;
  if (!show_.expression.empty()) {
    auto done = cue(kLead, [show = show_](fsm::FaceMotion& motion) {
      return motion.expression.Show(kLead, show.expression, show.pattern, 1, 0ms);
    });
    if (!done) return done;
    settled = trial->SettledAt(kLead);
  }
  vm::Time end = settled;
  if (!show_.motion.empty()) {
    auto done = cue(kLead, [show = show_](fsm::FaceMotion& motion) {
      return motion.PlayMovement(kLead, show.motion, show.motion_pattern);
    });
    if (!done) return done;
    end = std::max(end, trial->EndsAt(kLead));
  }
  if (!show_.speech.empty()) {
    auto done = cue(kLead, [show = show_, at = settled + 150ms](fsm::FaceMotion& motion) {
      motion.speech.Start(kLead, show.speech, at);
      return vm::Result<void>();
    });
    if (!done) return done;
    end = std::max(end, trial->speech.End().value_or(end));
  }
  if (!show_.expression.empty()) {
    if (show_.speech.empty()) end = std::max(end, settled + kHold);
    auto done = cue(end, [end](fsm::FaceMotion& motion) {
      motion.expression.Neutral(end);
      return vm::Result<void>();
    });
    if (!done) return done;
    end = trial->SettledAt(end);
  }
  length_ = end + kPause;
  cues_ = std::move(cues);
  version_ = editor_.state().version;
  motion_ = Fresh();
  given_ = 0;
  return {};
}

vm::Time Player::Local(vm::Time now) const {
  const vm::Time since = std::max(now - start_, vm::Time(0));
  return loop_ ? since % length_ : since;
}

bool Player::playing(vm::Time now) const { return motion_ && (loop_ || now < start_ + length_); }

std::optional<fsm::FaceState> Player::At(vm::Time now) {
  if (!playing(now)) return std::nullopt;
  const auto differs = [this](Part part) {
    const auto i = static_cast<std::size_t>(part);
    return version_[i] != editor_.state().version[i];
  };
  const bool edited =
      differs(Part::kExpressions) || differs(Part::kMouth) || differs(Part::kMotions);
  if (edited && !Plan()) {
    Stop();  // what was played is gone
    return std::nullopt;
  }
  const vm::Time local = Local(now);
  if (local < asked_ && given_ > 0) {
    motion_ = Fresh();
    given_ = 0;
  }
  asked_ = local;
  for (; given_ < cues_.size() && cues_[given_].at <= local; ++given_) {
    static_cast<void>(cues_[given_].command(*motion_));  // it was tried
  }
  return motion_->StateAt(local);
}

std::string Player::PhonemeAt(vm::Time now) {
  if (!At(now)) return "";
  return motion_->speech.PhonemeAt(Local(now));
}

fsm::FaceState StateOf(const fsm::FaceLook& look) {
  fsm::FaceState state;
  state.au = look.au;
  state.gaze = look.gaze;
  return state;
}

}  // namespace editor
