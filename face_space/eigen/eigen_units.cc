#include "face_space/eigen/eigen_units.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>

namespace facespace {
namespace {

constexpr double kBegins = 0.2, kEnds = 0.07;  // parts of a recording's greatest move
constexpr double kAtItsMost = 0.96;            // part of a performance's greatest move
constexpr double kShortestMs = 80, kPauseMs = 120;

/// Sums up by how much moves are missed.
class Misses {
 public:
  void Add(const Eigen::Ref<const Eigen::MatrixXd>& missed) {
    for (Eigen::Index t = 0; t < missed.cols(); ++t) {
      for (Eigen::Index m = 0; m + 2 < missed.rows(); m += 3) {
        const double square = missed.col(t).segment<3>(m).squaredNorm();
        squares_ += square;
        worst_ = std::max(worst_, square);
        count_ += 1;
      }
    }
  }
  Missing Total() const { return {std::sqrt(squares_ / std::max(count_, 1.0)), std::sqrt(worst_)}; }

 private:
  double squares_ = 0, worst_ = 0, count_ = 0;
};

struct Run {
  Eigen::Index first, last;
};

/// Where the face is away from rest, from one rest to the next.
std::vector<Run> RunsOf(const Eigen::VectorXd& away, const std::vector<double>& ms) {
  const double greatest = away.maxCoeff();
  const auto at = [&ms](Eigen::Index t) { return ms[static_cast<std::size_t>(t)]; };
  std::vector<Run> runs;
  for (Eigen::Index t = 0; t < away.size(); ++t) {
    if (away[t] < kBegins * greatest) continue;
    if (!runs.empty() && at(t) - at(runs.back().last) < kPauseMs) {
      runs.back().last = t;
    } else {
      runs.push_back({t, t});
    }
  }
  std::erase_if(runs, [&](const Run& run) { return at(run.last) - at(run.first) < kShortestMs; });
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Eigen::Index before = i == 0 ? 0 : runs[i - 1].last + 1;
    const Eigen::Index behind = i + 1 < runs.size() ? runs[i + 1].first - 1 : away.size() - 1;
    while (runs[i].first > before && away[runs[i].first] > kEnds * greatest) --runs[i].first;
    while (runs[i].last < behind && away[runs[i].last] > kEnds * greatest) ++runs[i].last;
  }
  // What is cut off by the end of the recording is no whole expression.
  std::erase_if(runs, [&](const Run& run) {
    return away[run.first] > kBegins * greatest || away[run.last] > kBegins * greatest;
  });
  return runs;
}

Performance Cut(const Eigen::MatrixXd& coefficients, const std::vector<double>& ms, const Run& run,
                const Eigen::VectorXd& away) {
  Performance out;
  out.first = run.first;
  out.last = run.last;
  out.course.resize(coefficients.rows(), EigenUnits::kCourse);
  const double begin = ms[static_cast<std::size_t>(run.first)];
  const double length = ms[static_cast<std::size_t>(run.last)] - begin;
  Eigen::Index t = run.first;
  for (Eigen::Index k = 0; k < EigenUnits::kCourse; ++k) {
    const double now = begin + length * static_cast<double>(k) / (EigenUnits::kCourse - 1);
    while (t + 1 < run.last && ms[static_cast<std::size_t>(t) + 1] < now) ++t;
    const double from = ms[static_cast<std::size_t>(t)], to = ms[static_cast<std::size_t>(t) + 1];
    const double share = std::clamp((now - from) / (to - from), 0.0, 1.0);
    out.course.col(k) = (1 - share) * coefficients.col(t) + share * coefficients.col(t + 1);
  }
  const double greatest = away.segment(run.first, run.last - run.first + 1).maxCoeff();
  out.peak = Eigen::VectorXd::Zero(coefficients.rows());
  double count = 0;
  for (Eigen::Index f = run.first; f <= run.last; ++f) {
    if (away[f] < kAtItsMost * greatest) continue;
    out.peak += coefficients.col(f);
    count += 1;
  }
  out.peak /= count;
  return out;
}

}  // namespace

Eigen::MatrixXd EigenUnits::Motion(Eigen::Index vector) const {
  return Eigen::MatrixXd::Map(motion.vectors.col(vector).data(), face.count(), kCourse);
}

vm::Result<EigenUnits> FindEigenUnits(const StillFaces& faces, const Kept& face,
                                      const Kept& motion) {
  Eigen::Index frames = 0;
  for (const FaceMoves& recording : faces.faces) frames += recording.moves.cols();
  Eigen::MatrixXd all(faces.faces.front().moves.rows(), frames);
  Eigen::Index at = 0;
  for (const FaceMoves& recording : faces.faces) {
    all.middleCols(at, recording.moves.cols()) = recording.moves;
    at += recording.moves.cols();
  }
  EigenUnits out;
  out.face = FindPrincipal(all, face);
  out.moved_mm = std::sqrt(3 * out.face.total / static_cast<double>(all.size()));
  const Eigen::MatrixXd coefficients = out.face.vectors.transpose() * all;
  out.least = coefficients.rowwise().minCoeff();
  out.most = coefficients.rowwise().maxCoeff();
  Misses by_face;
  by_face.Add(all - out.face.vectors * coefficients);
  out.by_face = by_face.Total();

  at = 0;
  for (std::size_t r = 0; r < faces.faces.size(); ++r) {
    const FaceMoves& recording = faces.faces[r];
    const Eigen::MatrixXd own = coefficients.middleCols(at, recording.moves.cols());
    at += recording.moves.cols();
    const Eigen::VectorXd away = own.colwise().norm().transpose();
    for (const Run& run : RunsOf(away, recording.ms)) {
      out.performances.push_back(Cut(own, recording.ms, run, away));
      out.performances.back().recording = r;
    }
  }
  if (out.performances.empty()) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("{}: no expression found that begins and ends at rest",
                                faces.faces.front().name));
  }
  const auto count = static_cast<Eigen::Index>(out.performances.size());
  Eigen::MatrixXd courses(out.face.count() * EigenUnits::kCourse, count);
  for (Eigen::Index p = 0; p < count; ++p) {
    courses.col(p) = out.performances[static_cast<std::size_t>(p)].course.reshaped();
  }
  out.motion = FindPrincipal(courses, motion);
  const Eigen::MatrixXd again = out.motion.vectors * (out.motion.vectors.transpose() * courses);
  Misses by_motion;
  for (Eigen::Index p = 0; p < count; ++p) {
    const Eigen::VectorXd missed = courses.col(p) - again.col(p);
    by_motion.Add(out.face.vectors *
                  Eigen::MatrixXd::Map(missed.data(), out.face.count(), EigenUnits::kCourse));
  }
  out.by_motion = by_motion.Total();
  return out;
}

vm::Result<std::vector<RecordedUnit>> TakeApart(const EigenUnits& units,
                                                const std::vector<std::vector<Label>>& labels) {
  std::map<std::string, Eigen::Index> index;
  std::vector<RecordedUnit> out;
  for (const auto& of_recording : labels) {
    for (const Label& label : of_recording) {
      if (!index.try_emplace(label.unit, static_cast<Eigen::Index>(out.size())).second) continue;
      out.push_back({.name = label.unit, .moves = {}, .in = 0});
    }
  }
  std::vector<const Performance*> used;
  for (const Performance& performance : units.performances) {
    if (!labels[performance.recording].empty()) used.push_back(&performance);
  }
  const auto rows = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(out.size()));
  Eigen::MatrixXd peaks(rows, units.face.count());
  for (Eigen::Index p = 0; p < rows; ++p) {
    const Performance& performance = *used[static_cast<std::size_t>(p)];
    peaks.row(p) = performance.peak.transpose();
    for (const Label& label : labels[performance.recording]) {
      const Eigen::Index u = index.find(label.unit)->second;
      shares(p, u) += label.strength;
      ++out[static_cast<std::size_t>(u)].in;
    }
  }
  for (const RecordedUnit& unit : out) {
    if (unit.in == 0) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("unit '{}' is in no expression that was found "
                                  "in the recordings",
                                  unit.name));
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(shares);
  if (solver.rank() < shares.cols()) {
    const Eigen::Index lost = solver.colsPermutation().indices()[solver.rank()];
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("unit '{}' cannot be told apart from others: {} expressions show it, "
                    "always in the same mixture",
                    out[static_cast<std::size_t>(lost)].name,
                    out[static_cast<std::size_t>(lost)].in));
  }
  const Eigen::MatrixXd found = solver.solve(peaks);  // units x face vectors
  for (std::size_t u = 0; u < out.size(); ++u) {
    out[u].moves = units.face.vectors * found.row(static_cast<Eigen::Index>(u)).transpose();
  }
  return out;
}

}  // namespace facespace
