#include "vdm/train/head_score.h"

#include <algorithm>
#include <cmath>

#include "vdm/mouth/mouth_tracker.h"
#include "vdm/prosody/head_mover.h"
#include "vdm/prosody/prosody_stream.h"

namespace vdm {
namespace {

constexpr double kHopMs = 10;

float ValueOf(const HeadPose& pose, std::size_t output) {
  return output < 3 ? pose.angles[output] : pose.brow;
}

/// Less its own mean from half a second before to half a second after: without the pose of a
/// phrase, which is by chance in both.
std::vector<double> Quick(const std::vector<float>& course) {
  constexpr std::size_t kReach = 50;
  std::vector<double> sums(1), out;
  for (const float value : course) sums.push_back(sums.back() + static_cast<double>(value));
  for (std::size_t k = 0; k < course.size(); ++k) {
    const std::size_t first = k < kReach ? 0 : k - kReach;
    const std::size_t last = std::min(k + kReach + 1, course.size());
    out.push_back(static_cast<double>(course[k]) -
                  (sums[last] - sums[first]) / static_cast<double>(last - first));
  }
  return out;
}

/// The nearest of `beats` to `at`, less `at`.
double NearestTo(double at, const std::vector<double>& beats) {
  double nearest = 1e9;
  for (const double beat : beats) {
    if (std::abs(beat - at) < std::abs(nearest)) nearest = beat - at;
  }
  return nearest;
}

}  // namespace

std::vector<HeadPose> HeadOf(const HeadNet& net, const std::vector<std::int16_t>& samples,
                             float emotion) {
  MouthTracker mouth(ShippedNet(FeatureKind::kMel));
  ProsodyStream prosody(mouth.ahead_samples());
  HeadMover mover(net);
  std::vector<std::int16_t> sound = samples;
  sound.resize(sound.size() + mouth.ahead_samples());
  prosody.Add(sound);
  std::vector<HeadPose> poses;
  for (const MouthTracker::Moment& moment : mouth.Add(sound)) {
    HeadPose pose;
    prosody.Advance(moment.sample, 1 - moment.frame.sounds.front(), [&](const ProsodyFrame& frame) {
      pose = mover.Add(frame, prosody.usual(), prosody.phrases(), moment.frame.sounds, emotion, 1);
    });
    poses.push_back(pose);
  }
  return poses;
}

std::vector<double> BeatsOf(const std::vector<HeadPose>& poses) {
  std::vector<double> beats;
  bool down = false;  // on the way down: a beat is where the highest angle since is
  float most = 0, least = poses.empty() ? 0 : poses.front().angles[0];
  std::size_t at = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const float angle = poses[k].angles[0];
    if (down) {
      if (angle > most) most = angle, at = k;
      if (angle > most - HeadScore::kBeatDegrees) continue;
      beats.push_back(kHopMs * static_cast<double>(at));
      down = false;
      least = angle;
    } else {
      least = std::min(least, angle);
      if (angle < least + HeadScore::kBeatDegrees) continue;
      down = true;
      most = angle;
      at = k;
    }
  }
  return beats;
}

void HeadScore::Add(const std::vector<HeadPose>& ours, const std::vector<HeadPose>& truth) {
  const std::size_t count = std::min(ours.size(), truth.size());
  for (const auto& [poses, courses] : {std::pair(&ours, &ours_), std::pair(&truth, &truth_)}) {
    auto& course = courses->emplace_back();
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < course.size(); ++i) course[i].push_back(ValueOf((*poses)[k], i));
    }
  }
  const auto our_beats = BeatsOf(ours), true_beats = BeatsOf(truth);
  our_beats_ += our_beats.size();
  true_beats_ += true_beats.size();
  for (const double beat : true_beats) {
    const double late = NearestTo(beat, our_beats);
    if (std::abs(late) <= kNearMs) ++found_, late_ms_ += late;
    for (double shift = -3000; shift <= 3000; shift += 250) {
      if (std::abs(shift) < 1000) continue;
      ++chances_;
      by_chance_ += std::abs(NearestTo(beat + shift, our_beats)) <= kNearMs;
    }
  }
  for (const double beat : our_beats) {
    right_ += std::abs(NearestTo(beat, true_beats)) <= kNearMs;
  }
}

double HeadScore::correlation(std::size_t output, int late_ms) const {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  const auto shift = static_cast<std::ptrdiff_t>(late_ms / kHopMs);
  for (std::size_t take = 0; take < ours_.size(); ++take) {
    const auto a = Quick(ours_[take][output]), b = Quick(truth_[take][output]);
    const auto size = static_cast<std::ptrdiff_t>(a.size());
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, -shift); k < std::min(size, size - shift);
         ++k) {
      const double u = a[static_cast<std::size_t>(k + shift)], v = b[static_cast<std::size_t>(k)];
      ++n, x += u, y += v, xx += u * u, yy += v * v, xy += u * v;
    }
  }
  const double square = (n * xx - x * x) * (n * yy - y * y);
  return square <= 0 ? 0 : (n * xy - x * y) / std::sqrt(square);
}

double HeadScore::range(std::size_t output, bool of_truth) const {
  Course all;
  for (const auto& take : of_truth ? truth_ : ours_) {
    all.insert(all.end(), take[output].begin(), take[output].end());
  }
  if (all.empty()) return 0;
  std::ranges::sort(all);
  const auto last = static_cast<double>(all.size() - 1);
  return static_cast<double>(all[static_cast<std::size_t>(0.975 * last)] -
                             all[static_cast<std::size_t>(0.025 * last)]);
}

double HeadScore::speed(std::size_t output, bool of_truth) const {
  double squares = 0, count = 0;
  for (const auto& take : of_truth ? truth_ : ours_) {
    for (std::size_t k = 1; k < take[output].size(); ++k) {
      const double step =
          static_cast<double>(take[output][k] - take[output][k - 1]) * 1000 / kHopMs;
      squares += step * step;
      ++count;
    }
  }
  return count == 0 ? 0 : std::sqrt(squares / count);
}

}  // namespace vdm
