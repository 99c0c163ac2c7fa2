#include "vdm/net/mouth_frame.h"

#include <algorithm>
#include <cmath>

namespace vdm {
namespace {

// Where the lips begin to close and where they are sealed, by the likelihood of a closure that is
// not decided (below). These and the thresholds of closures were chosen on recordings of a person
// speaking prompts (docs/vdm.md, Closures that last).
constexpr float kClosing = 0.5F, kClosed = 0.8F;
constexpr float kMmPerDegree = 1.4F;

/// How a number of the network becomes one of the mouth: so much larger, since a network that is
/// not sure says something nearer to the mean, and then within what shapes of the mouth reach.
struct Scaling {
  float gain, least, most;
};
constexpr float kFar = 1000;
// With these gains movements have about the right size (`size` of bench/vdm_bench.cc; docs/vdm.md).
// Rounding is heard less surely than opening. Limits: those of the shapes in
// fsm/motion/tables/mouth_shapes_28.txt; the jaw does not go up beyond its rest.
constexpr std::array<Scaling, kMouthParameters> kScalings = {{
    {1.2F, -kFar, kFar},  // upper lip, outer: up
    {1.5F, -1, 6},        // - forward
    {1.2F, -kFar, kFar},  // - inner: up
    {1.5F, -1.6F, 5.6F},  // - forward
    {1.2F, -kFar, kFar},  // lower lip, inner: up
    {1.5F, -4, 5.6F},     // - forward
    {1.2F, -kFar, kFar},  // - outer: up
    {1.5F, -2.6F, 6},     // - forward
    {1.5F, -9, 3.5F},     // corners: outward
    {1.2F, -kFar, kFar},  // - up
    {1.5F, -1.2F, 3.4F},  // - forward
    {1.2F, 0, kFar},      // jaw: opening
    {1.2F, -kFar, kFar},  // - thrust
    {1.5F, -0.6F, 0.3F},  // fullness: upper lip, outer
    {1.5F, -0.4F, 0.8F},  // - inner
    {1.5F, -0.2F, 0.6F},  // - lower lip, outer
    {1.5F, -1.2F, 0.2F},  // - inner
}};

// A closure is decided where one is so likely and p, b or m so likely, too. It lasts at least
// kHeldMs, and as long as it is likelier than kReleased; but after kLeastMs a vowel ends it.
constexpr float kDecided = 0.33F, kLeastClosure = 0.4F, kReleased = 0.5F, kVowel = 0.35F;
constexpr double kHeldMs = 40, kLeastMs = 20;
// Lips pressed, row `b` of mouth_shapes_28.txt, and how far those of a closure go there.
constexpr std::array<float, kMouthParameters> kPressedLips = {
    -1.9F, -0.6F, -0.6F, -1.6F, 1.0F,  -1.8F, 2.3F, -0.8F, 0.4F,
    0.0F,  -0.5F, 1.0F,  0.0F,  -0.6F, -0.4F, 0.6F, -0.4F};
constexpr float kPressed = 0.8F;
// In silence the mouth stays for so long, and is then home but for 1/e of the way in so long.
constexpr double kWaitMs = 100, kHomeMs = 30;

}  // namespace

float MouthFrame::Opening() const {
  const float lips = mouth[2] - mouth[4] + kMmPerDegree * mouth[11];
  return std::max(lips, 0.0F) * (1 - seal);
}

MouthFrame FrameOf(const MouthNet& net, const Eigen::Ref<const Eigen::VectorXf>& outputs) {
  MouthFrame frame;
  const auto value = [&](std::size_t row) { return outputs[static_cast<Eigen::Index>(row)]; };
  const float closed = 1 / (1 + std::exp(-value(net.closure_row())));
  const float u = std::clamp((closed - kClosing) / (kClosed - kClosing), 0.0F, 1.0F);
  frame.seal = u * u * (3 - 2 * u);

  const auto logits = outputs.tail(static_cast<Eigen::Index>(net.sounds.size()));
  const Eigen::VectorXf powers = (logits.array() - logits.maxCoeff()).exp();
  const float sum = powers.sum();
  for (const float power : powers) frame.sounds.push_back(power / sum);

  // Behind sealed lips of a pause the mouth goes home; behind those of p, b and m it stays.
  const float sounding = 1 - frame.seal * frame.sounds.front();
  for (std::size_t i = 0; i < kMouthParameters; ++i) {
    const Scaling& scaling = kScalings[i];
    frame.mouth[i] = sounding * std::clamp(net.means[i] + scaling.gain * net.scales[i] * value(i),
                                           scaling.least, scaling.most);
  }
  const float tongue =
      net.means[kMouthParameters] + net.scales[kMouthParameters] * value(kMouthParameters);
  frame.tongue = sounding * std::clamp(tongue, 0.0F, 1.0F);
  return frame;
}

MouthMotion::MouthMotion(const MouthNet& net, double hop_ms) : net_(net), hop_ms_(hop_ms) {
  const auto index = [&](const char* name) {
    return static_cast<std::size_t>(std::ranges::find(net.sounds, name) - net.sounds.begin());
  };
  closures_ = index("pbm");
  first_vowel_ = index("aa");
}

MouthFrame MouthMotion::Next(const Eigen::Ref<const Eigen::VectorXf>& outputs) {
  MouthFrame frame = FrameOf(net_, outputs);
  Press(frame, 1 / (1 + std::exp(-outputs[static_cast<Eigen::Index>(net_.closure_row())])));
  Wait(frame);
  last_ = frame;
  return frame;
}

void MouthMotion::Press(MouthFrame& frame, float closed) {
  if (closures_ == frame.sounds.size()) return;
  const float silence = frame.sounds.front(), closure = frame.sounds[closures_];
  float vowel = 0;
  for (std::size_t i = first_vowel_; i < frame.sounds.size(); ++i) vowel += frame.sounds[i];
  if (pressed_ms_ < 0) {
    if (closed < kDecided || closure < std::max(silence, kLeastClosure)) return;
    pressed_ms_ = 0;
  } else {
    pressed_ms_ += hop_ms_;
    const bool vowel_heard = vowel > kVowel && closed < kDecided && pressed_ms_ >= kLeastMs;
    if (vowel_heard || (pressed_ms_ >= kHeldMs && closed < kReleased)) {
      pressed_ms_ = -1;
      return;
    }
  }
  frame.seal = 1;
  for (std::size_t i = 0; i < kMouthParameters; ++i) {
    frame.mouth[i] += kPressed * (kPressedLips[i] - frame.mouth[i]);
  }
}

void MouthMotion::Wait(MouthFrame& frame) {
  if (frame.sounds.front() < 0.5F || pressed_ms_ >= 0) {
    silent_ms_ = 0;
    return;
  }
  silent_ms_ += hop_ms_;
  if (!last_) return;
  const float share =
      silent_ms_ <= kWaitMs ? 0 : 1 - std::exp(-static_cast<float>(hop_ms_ / kHomeMs));
  const auto go = [&](float& now, float before) { now = before + share * (now - before); };
  for (std::size_t i = 0; i < kMouthParameters; ++i) go(frame.mouth[i], last_->mouth[i]);
  go(frame.seal, last_->seal);
  go(frame.tongue, last_->tongue);
}

}  // namespace vdm
