#include "vdm/train/score.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vdm {
namespace {

constexpr double kOpenMm = 3, kOpenForMs = 30, kNearMs = 20;

bool IsClosure(const std::string& name) {
  return name == "p" || name == "b" || name == "m" || name == "em" || name == "my" ||
         name == "by" || name == "py";
}

/// True if some instant of [from, to) ms has an opening below the limit.
bool IsShut(const std::vector<double>& openings, double step_ms, double from, double to) {
  const auto last = static_cast<std::ptrdiff_t>(openings.size());
  const auto index = [&](double ms) {
    return std::clamp(static_cast<std::ptrdiff_t>(std::ceil(ms / step_ms)), std::ptrdiff_t{0},
                      last);
  };
  return std::any_of(openings.begin() + index(from), openings.begin() + index(to),
                     [](double mm) { return mm < Score::kShutMm; });
}

}  // namespace

void Score::Add(const std::vector<double>& ours, const std::vector<double>& truth, double step_ms,
                const vm::PhonemeList& phonemes) {
  assert(ours.size() == truth.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    ++n_;
    x_ += ours[i];
    y_ += truth[i];
    xx_ += ours[i] * ours[i];
    yy_ += truth[i] * truth[i];
    xy_ += ours[i] * truth[i];
  }
  double start = 0;
  for (const vm::Phoneme& phoneme : phonemes) {
    const double end = start + static_cast<double>(phoneme.duration.count());
    if (IsClosure(phoneme.name) && IsShut(truth, step_ms, start, end)) {
      ++closures_;
      seen_ += IsShut(ours, step_ms, start - kNearMs, end + kNearMs);
    }
    start = end;
  }
  const auto margin = static_cast<std::size_t>(kOpenForMs / step_ms);
  for (std::size_t i = margin; i + margin < truth.size(); ++i) {
    const auto from = truth.begin() + static_cast<std::ptrdiff_t>(i - margin);
    const auto to = truth.begin() + static_cast<std::ptrdiff_t>(i + margin + 1);
    if (*std::min_element(from, to) < kOpenMm) continue;
    ++open_;
    wrongly_shut_ += ours[i] < kShutMm;
  }
}

double Score::correlation() const {
  const auto n = static_cast<double>(n_);
  const double spread = std::sqrt((n * xx_ - x_ * x_) * (n * yy_ - y_ * y_));
  return spread > 0 ? (n * xy_ - x_ * y_) / spread : 0;
}

double Score::size() const {
  const auto n = static_cast<double>(n_);
  const double truth = n * yy_ - y_ * y_;
  return truth > 0 ? std::sqrt(std::max(0.0, n * xx_ - x_ * x_) / truth) : 0;
}

double Score::rms_mm() const {
  return n_ == 0 ? 0 : std::sqrt(std::max(0.0, xx_ + yy_ - 2 * xy_) / static_cast<double>(n_));
}

}  // namespace vdm
