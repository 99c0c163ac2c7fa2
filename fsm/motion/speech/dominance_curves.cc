#include "fsm/motion/speech/dominance_curves.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fsm/motion/base/easing.h"
#include "fsm/motion/base/track.h"

namespace fsm {
namespace {

constexpr double kForever = 1e9;
constexpr double kFalloff = 3;  // exp(-3) = 5 % at the reach

// The dominance that applies to each MouthParameter: that of jaw, opening of the lips, or rounding.
enum Group : std::size_t { kJaw, kLips, kRound, kTongue, kGroups };
constexpr std::array<Group, kMouthParameters> kGroupOf = {
    kLips,  kRound, kLips, kRound, kLips, kRound, kLips, kRound, kRound,
    kRound, kRound, kJaw,  kJaw,   kLips, kLips,  kLips, kLips};

double Falloff(double distance_ms, double reach_ms) {
  const double d = distance_ms / reach_ms;
  return std::exp(-kFalloff * d * d);
}

}  // namespace

double DominanceCurves::ContactEnvelope::At(double position_ms) const {
  const auto share = [](double begin, double end, double at) {
    return end <= begin ? (at >= end ? 1.0 : 0.0) : SmoothStep((at - begin) / (end - begin));
  };
  return std::min(share(rise, from, position_ms), 1 - share(to, fall, position_ms));
}

DominanceCurves::DominanceCurves(const VisemeTargets& targets, const DominanceReach& reach,
                                 const MovementNumbers& sizes)
    : reach_(reach), contact_(sizes.contact) {
  VisemeTarget rest;
  rest.pose = targets.rest;
  rest.dominance = targets.rest_dominance;
  rest.pause = true;
  rest.length_ms = kForever;
  rest.start_ms = -kForever;
  sounds_.push_back({rest, 0, {}});
  longest_reach_ms_ = std::max(reach.before_ms, reach.after_ms);
  for (const VisemeTarget& target : targets.targets) {
    sounds_.push_back({target, target.start_ms + target.length_ms, {}});
    longest_reach_ms_ = std::max(longest_reach_ms_, target.dominance.early_ms);
  }
  rest.start_ms = targets.length_ms;
  sounds_.push_back({rest, targets.length_ms + kForever, {}});
  PlaceContacts();
}

void DominanceCurves::PlaceContacts() {
  const auto closes = [this](std::size_t i) {
    const VisemeTarget& target = sounds_[i].target;
    return target.pose.seal > 0 && !(target.pause && target.length_ms < contact_.min_pause_ms);
  };
  for (std::size_t i = 0; i < sounds_.size(); ++i) {
    Sound& sound = sounds_[i];
    const VisemeTarget& target = sound.target;
    if (target.pose.contact <= 0) continue;
    if (target.pause && target.length_ms < contact_.min_pause_ms) continue;
    const bool closed_before = i == 0 || (closes(i) && closes(i - 1));
    const bool closed_after = i + 1 == sounds_.size() || (closes(i) && closes(i + 1));
    const double start = target.start_ms;
    ContactEnvelope contact{};
    if (target.pause) {
      // The lips meet after the end of the sound before, and part before the next one begins.
      contact = {start, start + contact_.ease_ms, sound.end_ms - contact_.ease_ms, sound.end_ms};
    } else {
      const double min = contact_.approach_ms.from, max = contact_.approach_ms.to;
      const double before = i == 0 ? max : sounds_[i - 1].target.length_ms;
      const double to = start + std::min(target.hold_ms, target.length_ms);
      contact = {start - std::clamp(contact_.approach_percent / 100.0 * before, min, max), start,
                 to, std::max(sound.end_ms, to + contact_.release_ms)};
    }
    // Between adjacent closures the lips stay closed; their shape is blended from one to the other.
    if (closed_before) {
      contact.rise = start - contact_.overlap_ms;
      contact.from = start;
    }
    if (closed_after) {
      contact.to = sound.end_ms;
      contact.fall = sound.end_ms + contact_.overlap_ms;
    }
    sound.contact = contact;
  }
}

/// Accumulates the sounds and contacts that contribute at one instant.
class DominanceCurves::Blend {
 public:
  using Weights = std::array<double, kGroups>;

  void Add(const MouthPose& target, const Weights& dominance) {
    for (std::size_t g = 0; g < kGroups; ++g) weight_[g] += dominance[g];
    for (std::size_t p = 0; p < kMouthParameters; ++p) {
      mouth_[p] += dominance[kGroupOf[p]] * target.mouth[p];
    }
    tongue_ += dominance[kTongue] * target.tongue;
  }

  void AddContact(const MouthPose& target, double made01, double jaw_part) {
    const double contact = made01 * target.contact;
    pose_.seal = std::max(pose_.seal, static_cast<float>(made01 * target.seal));
    pose_.contact = std::max(pose_.contact, static_cast<float>(contact));
    contacts_ += contact;
    jaw_share_sum_ += contact * (target.seal > 0 ? jaw_part : 1);
    for (std::size_t p = 0; p < kMouthParameters; ++p) {
      held_.mouth[p] += static_cast<float>(contact * target.mouth[p]);
    }
  }

  MouthPose Pose() const {
    constexpr double kMinSum = 1e-6;  // below this sum of dominances the mouth is at rest
    MouthPose pose = pose_;
    for (std::size_t p = 0; p < kMouthParameters; ++p) {
      double value = mouth_[p] / (weight_[kGroupOf[p]] + kMinSum);
      if (contacts_ > 0) {
        const double share = pose.contact * (kGroupOf[p] == kJaw ? jaw_share_sum_ / contacts_ : 1);
        value += share * (held_.mouth[p] / contacts_ - value);
      }
      pose.mouth[p] = static_cast<float>(value);
    }
    pose.tongue = static_cast<float>(tongue_ / (weight_[kTongue] + kMinSum));
    return pose;
  }

 private:
  Weights weight_{};
  std::array<double, kMouthParameters> mouth_{};
  double tongue_ = 0;
  MouthPose held_;  // sum of the contacts' targets, weighted by ContactEnvelope::At
  double contacts_ = 0;
  double jaw_share_sum_ = 0;
  MouthPose pose_;  // seal and contact
};

MouthPose DominanceCurves::At(double position_ms) const {
  Blend blend;
  // Find the first sound within reach.
  const auto first = std::ranges::partition_point(
      sounds_, [&](const Sound& s) { return s.end_ms + longest_reach_ms_ * 3 < position_ms; });
  for (auto s = first; s != sounds_.end(); ++s) {
    const VisemeTarget& target = s->target;
    if (target.start_ms - longest_reach_ms_ * 3 > position_ms) break;
    const Dominance& d = target.dominance;
    const bool early = position_ms < target.start_ms;
    const double distance = std::max({target.start_ms - position_ms, position_ms - s->end_ms, 0.0});
    const double near = Falloff(distance, early ? reach_.before_ms : reach_.after_ms);
    const double round = Falloff(distance, early ? d.early_ms : reach_.after_ms);
    blend.Add(target.pose, {d.jaw * near, d.lips * near, d.round * round, d.tongue * near});
    if (s->contact) blend.AddContact(target.pose, s->contact->At(position_ms), contact_.jaw_share);
  }
  return blend.Pose();
}

}  // namespace fsm
