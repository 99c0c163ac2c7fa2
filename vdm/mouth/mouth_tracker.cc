#include "vdm/mouth/mouth_tracker.h"

namespace vdm {

MouthTracker::MouthTracker(const MouthNet& net, float warp)
    : net_(net),
      features_(MakeFeatures(net.features, warp)),
      stream_(net.net),
      motion_(net, static_cast<double>(features_->hop_samples()) / 16) {}

std::size_t MouthTracker::ahead_samples() const {
  return features_->ahead_samples() + net_.net.ahead() * features_->hop_samples();
}

std::vector<MouthTracker::Moment> MouthTracker::Add(std::span<const std::int16_t> samples) {
  vectors_.clear();
  features_->Add(samples, vectors_);
  const auto size = static_cast<Eigen::Index>(features_->size());
  std::vector<Moment> moments;
  for (std::size_t at = 0; at < vectors_.size(); at += features_->size()) {
    const Eigen::VectorXf& outputs =
        stream_.Add(Eigen::Map<const Eigen::VectorXf>(&vectors_[at], size));
    if (outputs.size() == 0) continue;
    moments.push_back({moments_++ * features_->hop_samples(), motion_.Next(outputs)});
  }
  return moments;
}

}  // namespace vdm
