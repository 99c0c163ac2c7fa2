#include "vdm/mouth/speaker_learner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace vdm {
namespace {

constexpr std::size_t kStep = kSampleRateHz / 100;  // as the hop of the networks' features
constexpr float kBelowPeakDb = 25, kAboveQuietDb = 10, kLeastDb = -90;
constexpr std::size_t kHole = 10, kShortest = 10, kOver = 30;  // steps
constexpr double kLeastFit = -2.5;  // a likelihood of 0.08 a vowel, in the (geometric) mean

}  // namespace

std::vector<Stretch> LoudStretches(const std::vector<float>& levels_db) {
  std::vector<Stretch> stretches;
  if (levels_db.empty()) return stretches;
  const auto [quiet, peak] = std::ranges::minmax(levels_db);
  const float loud = std::max(peak - kBelowPeakDb, quiet + kAboveQuietDb);
  for (std::size_t i = 0; i < levels_db.size(); ++i) {
    if (levels_db[i] < loud) continue;
    if (stretches.empty() || i >= stretches.back().end + kHole) stretches.push_back({i, i});
    stretches.back().end = i + 1;
  }
  std::erase_if(stretches, [](const Stretch& one) { return one.end - one.first < kShortest; });
  return stretches;
}

SpeakerLearner::SpeakerLearner(const MouthNet& net, const VowelTable& table) : table_(table) {
  for (const std::string& vowel : table.vowels) {
    const auto found = std::ranges::find(net.sounds, vowel);
    if (found != net.sounds.end()) {
      classes_.push_back(static_cast<std::size_t>(found - net.sounds.begin()));
    }
  }
  if (classes_.size() < table.vowels.size()) return;  // Best says so
  for (const float warp : table.warps) {
    candidates_.push_back({warp, std::make_unique<MouthTracker>(net, warp), {}});
  }
}

vm::Error SpeakerLearner::Failed(const std::string& what) const {
  return {vm::Errc::kBadValue,
          fmt::format("{}; the vowels {} one after the other expected, with pauses, within {} s",
                      what, fmt::join(table_.vowels, " "), kMostSteps / 100),
          0};
}

void SpeakerLearner::Measure(std::span<const std::int16_t> samples) {
  rest_.insert(rest_.end(), samples.begin(), samples.end());
  std::size_t at = 0;
  for (; rest_.size() - at >= kStep; at += kStep) {
    double sum = 0, mean = 0;
    for (std::size_t i = at; i < at + kStep; ++i) mean += rest_[i];
    mean /= kStep;
    for (std::size_t i = at; i < at + kStep; ++i) sum += (rest_[i] - mean) * (rest_[i] - mean);
    const double power = sum / kStep / (32768.0 * 32768.0);
    levels_.push_back(std::max(static_cast<float>(10 * std::log10(power + 1e-12)), kLeastDb));
  }
  rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(at));
}

std::optional<vm::Result<Speaker>> SpeakerLearner::Add(std::span<const std::int16_t> samples) {
  if (classes_.size() < table_.vowels.size()) {
    return std::unexpected(Failed("the network does not know all of these vowels"));
  }
  Measure(samples);
  for (Candidate& candidate : candidates_) {
    for (const MouthTracker::Moment& moment : candidate.tracker->Add(samples)) {
      std::vector<float> logs;
      for (const std::size_t one : classes_) {
        logs.push_back(std::log(moment.frame.sounds[one] + 1e-4F));
      }
      candidate.logs.push_back(std::move(logs));
    }
  }
  const auto stretches = LoudStretches(levels_);
  if (stretches.size() > classes_.size()) {
    return std::unexpected(Failed(fmt::format("{} stretches of sound found", stretches.size())));
  }
  if (stretches.size() == classes_.size() && levels_.size() >= stretches.back().end + kOver) {
    return Best(stretches);
  }
  if (levels_.size() < kMostSteps) return std::nullopt;
  return std::unexpected(Failed(fmt::format("{} stretches of sound found", stretches.size())));
}

vm::Result<Speaker> SpeakerLearner::Finish() {
  const std::vector<std::int16_t> silence(2 * kOver * kStep);
  if (auto met = Add(silence)) return *met;
  return std::unexpected(Failed(
      fmt::format("the sound ended after {} stretches of it", LoudStretches(levels_).size())));
}

double SpeakerLearner::FitOf(const Candidate& candidate,
                             const std::vector<Stretch>& stretches) const {
  double fit = 0;
  for (std::size_t v = 0; v < stretches.size(); ++v) {
    const std::size_t quarter = (stretches[v].end - stretches[v].first) / 4;
    double sum = 0;
    const std::size_t first = stretches[v].first + quarter, end = stretches[v].end - quarter;
    for (std::size_t i = first; i < end; ++i) sum += static_cast<double>(candidate.logs[i][v]);
    fit += sum / static_cast<double>(end - first) / static_cast<double>(stretches.size());
  }
  return fit;
}

vm::Result<Speaker> SpeakerLearner::Best(const std::vector<Stretch>& stretches) const {
  Speaker speaker;
  double best = -1e9;
  for (const Candidate& candidate : candidates_) {
    const double fit = FitOf(candidate, stretches);
    if (fit <= best) continue;
    best = fit;
    speaker.warp = candidate.warp;
  }
  if (best < kLeastFit) return std::unexpected(Failed("other sounds found"));
  return speaker;
}

}  // namespace vdm
