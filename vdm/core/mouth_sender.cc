#include "vdm/core/mouth_sender.h"

#include <fmt/format.h>

#include <utility>

namespace vdm {
namespace {

// A mouth that is not sealed, or is about to be; below it nobody sees it move.
bool Moves(const MouthFrame& frame) { return frame.seal < 0.98F || frame.mouth[11] > 0.3F; }

}  // namespace

void MouthSender::Begin(vm::Time at) {
  const bool was_still = !start_.has_value();
  start_ = at;
  events_.start(at);
  if (was_still) events_.moving(true);
}

void MouthSender::Send(vm::Time at, const MouthFrame& frame, const std::optional<HeadPose>& head) {
  events_.frame(static_cast<double>((at - *start_).count()) / 1000, frame, head);
  last_ = at;
  head_ = head;
}

void MouthSender::Add(vm::Time at, const MouthFrame& frame, const std::optional<HeadPose>& head) {
  const bool moves = Moves(frame);
  if (moves) active_ = at;
  if (!start_ && !moves) {
    before_.emplace(at, frame, head);
    return;
  }
  if (!start_) {
    const auto before = std::exchange(before_, std::nullopt);
    Begin(before ? before->at : at);
    if (before) Send(before->at, before->frame, before->head);
  }
  if (at - active_ > kRest) return Finish();
  if (at - *start_ > kLongestRun || at < last_) Begin(at);
  if (at == *start_ || at - last_ >= kEvery) Send(at, frame, head);
}

void MouthSender::Finish() {
  before_.reset();
  if (!start_) return;
  Send(last_ + kEvery, MouthFrame{}, head_);
  start_.reset();
  events_.moving(false);
}

std::string FrameText(double ms, const MouthFrame& frame, const std::optional<HeadPose>& head) {
  // Hundredths of a millimetre are enough; without "-0".
  const auto number = [](float value) {
    std::string text = fmt::format("{:.2f}", value);
    while (text.ends_with('0')) text.pop_back();
    if (text.ends_with('.')) text.pop_back();
    return text == "-0" ? std::string("0") : text;
  };
  std::string text = fmt::format("{:g}", ms);
  for (const float value : frame.mouth) text += " " + number(value);
  text += " " + number(frame.seal) + " " + number(frame.tongue);
  if (!head) return text;
  for (const float angle : head->angles) text += " " + number(angle);
  return text + " " + number(head->brow);
}

}  // namespace vdm
