#include "vdm/mouth/mouth_tracker.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace vdm {
namespace {

// What the second network counts for (docs/vdm.md, How near it comes).
constexpr float kShapeShare = 0.4F, kSoundShare = 0.5F;
// Two that are not sure of the same say something nearer to the mean than one, and are less sure of
// a closure: so much is added to its logits.
constexpr float kGain = 1.1F, kSurer = 0.25F;

}  // namespace

MouthTracker::Listener::Listener(const MouthNet& net, float warp)
    : net_(net), features_(MakeFeatures(net.features, warp)), stream_(net.net) {}

std::size_t MouthTracker::Listener::ahead_samples() const {
  return features_->ahead_samples() + net_.net.ahead() * features_->hop_samples();
}

void MouthTracker::Listener::Add(std::span<const std::int16_t> samples) {
  vectors_.clear();
  features_->Add(samples, vectors_);
  const auto size = static_cast<Eigen::Index>(features_->size());
  for (std::size_t at = 0; at < vectors_.size(); at += features_->size()) {
    const Eigen::VectorXf& outputs =
        stream_.Add(Eigen::Map<const Eigen::VectorXf>(&vectors_[at], size));
    if (outputs.size() > 0) said.push_back(outputs);
  }
}

MouthTracker::MouthTracker(const MouthNet& net, float warp, const MouthNet* second)
    : first_(net, warp), motion_(net, static_cast<double>(first_.hop_samples()) / 16) {
  if (second == nullptr) return;
  second_.emplace(*second, warp);
  if (const auto sound = std::ranges::find(net.sounds, "pbm"); sound != net.sounds.end()) {
    closure_sound_ =
        static_cast<Eigen::Index>(net.first_sound_row()) + (sound - net.sounds.begin());
  }
  assert(second->sounds == net.sounds && second_->hop_samples() == first_.hop_samples());
}

std::size_t MouthTracker::ahead_samples() const {
  return std::max(first_.ahead_samples(), second_ ? second_->ahead_samples() : 0);
}

/// `others`: what the second network says; it may have learned other means and scales.
void MouthTracker::Mix(Eigen::VectorXf& outputs, const Eigen::VectorXf& others) const {
  const MouthNet& net = first_.net();
  const MouthNet& other = second_->net();
  for (std::size_t i = 0; i < kShapeNumbers; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const float said =
        (other.means[i] + other.scales[i] * others[row] - net.means[i]) / net.scales[i];
    outputs[row] = kGain * (outputs[row] + kShapeShare * (said - outputs[row]));
  }
  const auto rest = outputs.size() - static_cast<Eigen::Index>(kShapeNumbers);
  outputs.tail(rest) += kSoundShare * (others.tail(rest) - outputs.tail(rest));
  outputs[static_cast<Eigen::Index>(net.closure_row())] += kSurer;
  if (closure_sound_) outputs[*closure_sound_] += kSurer;
}

std::vector<MouthTracker::Moment> MouthTracker::Add(std::span<const std::int16_t> samples) {
  first_.Add(samples);
  if (second_) second_->Add(samples);
  std::vector<Moment> moments;
  while (!first_.said.empty() && !(second_ && second_->said.empty())) {
    Eigen::VectorXf outputs = std::move(first_.said.front());
    first_.said.pop_front();
    if (second_) {
      Mix(outputs, second_->said.front());
      second_->said.pop_front();
    }
    moments.push_back({moments_++ * hop_samples(), motion_.Next(outputs)});
  }
  return moments;
}

}  // namespace vdm
