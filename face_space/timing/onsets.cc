#include "face_space/timing/onsets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "fsm/motion/base/easing.h"

namespace facespace {
namespace {

constexpr double kLow = 0.2, kHigh = 0.8;  // parts of the way by which a part's course is placed
constexpr double kStill = 0.1;             // a part that moves by less does not move
constexpr double kSettled = 0.97;          // of a rise: from here on it is at its peak
constexpr double kAroundMs = 40;           // over which rest and peak are averaged
constexpr int kTurns = 6;

double Whole(const ByRegion<double>& parts) {
  double squares = 0;
  for (const double part : parts) squares += part * part;
  return std::sqrt(squares);
}

/// Where fsm::SmootherStep comes to `part`, 0..1.
double Inverse(double part) {
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (fsm::SmootherStep(middle) < part ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Frames between which the face as a whole rises.
struct Rise {
  std::size_t rest, peak;
};

std::vector<Rise> FindRises(const std::vector<double>& whole) {
  std::vector<Rise> rises;
  std::size_t low = 0, high = 0;
  bool rising = false;
  const auto end_rise = [&] {
    const double from = whole[low], by = whole[high] - from;
    // Rest ends and the peak begins where the curve leaves the one and comes to the other.
    std::size_t rest = high, peak = low;
    while (rest > low && whole[rest] > from + (1 - kSettled) * by) --rest;
    while (peak < high && whole[peak] < from + kSettled * by) ++peak;
    rises.push_back({rest, peak});
  };
  for (std::size_t i = 1; i < whole.size(); ++i) {
    if (rising) {
      if (whole[i] > whole[high]) high = i;
      if (whole[high] - whole[i] < kLeastRise) continue;
      end_rise();
      rising = false;
      low = i;
    } else if (whole[i] < whole[low]) {
      low = i;
    } else if (whole[i] - whole[low] >= kLeastRise) {
      rising = true;
      high = i;
    }
  }
  if (rising) end_rise();
  return rises;
}

/// Where one part moves during a rise.
struct Way {
  double begins_ms, ends_ms, moved;
};

class RegionCourse {
 public:
  RegionCourse(const std::vector<double>& ms, const std::vector<ByRegion<double>>& courses,
               std::size_t region)
      : ms_(ms), courses_(courses), region_(region) {}

  std::optional<Way> During(const Rise& rise) const {
    // The part may begin before the face as a whole is seen to, and end after it: where it is at
    // rest and at its peak, and the way between, are found in turns.
    Way way{ms_[rise.rest], ms_[rise.peak], 0};
    for (int turn = 0; turn < kTurns; ++turn) {
      const double from = Mean(way.begins_ms - kAroundMs, way.begins_ms, rise.rest);
      const double to = Mean(way.ends_ms, way.ends_ms + kAroundMs, rise.peak);
      way.moved = to - from;
      if (std::abs(way.moved) < kStill) return std::nullopt;
      const auto low = Passes(rise, from + kLow * way.moved, to > from);
      const auto high = Passes(rise, from + kHigh * way.moved, to > from);
      if (!low || !high || *high <= *low) return std::nullopt;
      // The line u = (t - begins) / length through the frames between, by least squares, each with
      // the weight that noise of the course leaves its u.
      double sum = 0, sum_t = 0, sum_u = 0, sum_tt = 0, sum_tu = 0;
      const auto count = [&](double t, double part) {
        const double u = Inverse(part), slope = 30 * u * u * (1 - u) * (1 - u);
        const double weight = slope * slope, since = t - *low;
        sum += weight;
        sum_t += weight * since;
        sum_u += weight * u;
        sum_tt += weight * since * since;
        sum_tu += weight * since * u;
      };
      count(*low, kLow);
      count(*high, kHigh);
      for (auto at = std::ranges::upper_bound(ms_, *low); at != ms_.end() && *at < *high; ++at)
        count(*at, (At(static_cast<std::size_t>(at - ms_.begin())) - from) / way.moved);
      const double rate = (sum * sum_tu - sum_t * sum_u) / (sum * sum_tt - sum_t * sum_t);
      if (!(rate > 0)) return std::nullopt;
      way.begins_ms = *low + sum_t / sum - sum_u / sum / rate;
      way.ends_ms = way.begins_ms + 1 / rate;
    }
    return way;
  }

 private:
  double At(std::size_t frame) const { return courses_[frame][region_]; }
  /// Over the frames within two times; that at `frame` if there are none.
  double Mean(double from_ms, double to_ms, std::size_t frame) const {
    double sum = 0, count = 0;
    const auto first = std::ranges::lower_bound(ms_, from_ms);
    for (auto at = first; at != ms_.end() && *at <= to_ms; ++at, ++count)
      sum += At(static_cast<std::size_t>(at - ms_.begin()));
    return count > 0 ? sum / count : At(frame);
  }
  /// When the course passes `level` for the last time before the peak.
  std::optional<double> Passes(const Rise& rise, double level, bool upwards) const {
    const auto before = [&](std::size_t i) { return upwards ? At(i) < level : At(i) > level; };
    std::size_t last = rise.peak;
    while (last + 1 < ms_.size() && before(last)) ++last;  // it is later than the whole
    while (last > 0 && !before(last - 1)) --last;
    if (last == 0 || before(last)) return std::nullopt;
    const double a = At(last - 1), b = At(last);
    return ms_[last - 1] + (ms_[last] - ms_[last - 1]) * (level - a) / (b - a);
  }

  const std::vector<double>& ms_;
  const std::vector<ByRegion<double>>& courses_;
  const std::size_t region_;
};

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

/// Lags count from the part that begins first.
void CountFromFirst(Onset& onset) {
  double first = INFINITY;
  for (const auto& lag : onset.lag_ms) first = std::min(first, lag.value_or(INFINITY));
  for (auto& lag : onset.lag_ms) {
    if (lag) *lag -= first;
  }
}

}  // namespace

std::vector<ByRegion<double>> RegionCourses(const UnitTrack& track,
                                            const fsm::UnitRegions& regions) {
  std::vector<ByRegion<double>> courses;
  courses.reserve(track.looks.size());
  for (const fsm::FaceLook& look : track.looks) {
    ByRegion<double>& parts = courses.emplace_back();
    for (const fsm::UnitValues* side : {&look.au.left, &look.au.right}) {
      for (std::size_t unit = 0; unit < side->size(); ++unit) {
        const double strength = (*side)[unit];
        parts[static_cast<std::size_t>(regions.RegionOf(unit))] += strength * strength / 2;
      }
    }
    for (double& part : parts) part = std::sqrt(part);
  }
  return courses;
}

std::vector<Onset> FindOnsets(const UnitTrack& track, const fsm::UnitRegions& regions) {
  const std::vector<ByRegion<double>> courses = RegionCourses(track, regions);
  std::vector<double> whole;
  whole.reserve(courses.size());
  for (const ByRegion<double>& parts : courses) whole.push_back(Whole(parts));
  std::vector<Onset> onsets;
  for (const Rise& rise : FindRises(whole)) {
    Onset onset{.begins_ms = INFINITY, .onset_ms = 0, .lag_ms = {}};
    double ends_ms = -INFINITY;
    for (std::size_t region = 0; region < fsm::kRegions; ++region) {
      const auto way = RegionCourse(track.ms, courses, region).During(rise);
      if (!way) continue;
      onset.lag_ms[region] = way->begins_ms;
      onset.moved[region] = way->moved;
      onset.begins_ms = std::min(onset.begins_ms, way->begins_ms);
      ends_ms = std::max(ends_ms, way->ends_ms);
    }
    if (ends_ms <= onset.begins_ms) continue;  // no part's course could be placed
    onset.onset_ms = ends_ms - onset.begins_ms;
    CountFromFirst(onset);
    onsets.push_back(onset);
  }
  return onsets;
}

Onset MedianOnset(const std::vector<Onset>& onsets) {
  const auto median_of = [&](const auto& number) {
    std::vector<double> values;
    for (const Onset& onset : onsets) values.push_back(number(onset));
    return Median(std::move(values));
  };
  Onset median;
  median.begins_ms = median_of([](const Onset& onset) { return onset.begins_ms; });
  median.onset_ms = median_of([](const Onset& onset) { return onset.onset_ms; });
  for (std::size_t region = 0; region < fsm::kRegions; ++region) {
    median.moved[region] = median_of([&](const Onset& onset) { return onset.moved[region]; });
    std::vector<double> lags;
    for (const Onset& onset : onsets) {
      if (onset.lag_ms[region]) lags.push_back(*onset.lag_ms[region]);
    }
    if (2 * lags.size() > onsets.size()) median.lag_ms[region] = Median(std::move(lags));
  }
  CountFromFirst(median);
  return median;
}

vm::Result<std::string> WithTiming(const std::string& table, const std::string& kind,
                                   const std::string& emotion, const Onset& onset) {
  std::istringstream lines(table);
  std::string out, line;
  bool found = false;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string first, name;
    double whole_ms = 0;
    ByRegion<double> lags{};
    if (words >> first >> name >> whole_ms >> lags[0] >> lags[1] >> lags[2] && first == kind &&
        name == emotion) {
      found = true;
      for (std::size_t region = 0; region < fsm::kRegions; ++region)
        lags[region] = onset.lag_ms[region].value_or(lags[region]);
      line = fmt::format("{:<8} {:<9} {:.0f} {:.1f} {:.1f} {:.1f}", kind, emotion, onset.onset_ms,
                         lags[0], lags[1], lags[2]);
    }
    out += line + "\n";
  }
  if (!found) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("the table emotions.txt has no row '{} {}'", kind, emotion));
  }
  return out;
}

}  // namespace facespace
