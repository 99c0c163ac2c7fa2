#include "face_track/fit/unit_choice.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "face_track/fit/dose_prior.h"

namespace facetrack {
namespace {

using Matrix = Eigen::MatrixXf;
using Vector = Eigen::VectorXf;

constexpr Eigen::Index kPose = Evidence::kPose;
constexpr std::size_t kMostUnits = 6;
constexpr int kMostMoves = 12;
// Doses before they are known, and at most; below kNoDose a unit was not there.
constexpr float kFirstDose = 0.5F, kMostDose = 1, kNoDose = 0.1F;
// Candidates are compared after one round, the best ones after some more.
constexpr std::size_t kFinalists = 4;
constexpr int kFinalRounds = 2;
// By how much doses cost more in the choice than when they are found in the end.
constexpr float kDearer = 1.5F;
constexpr float kRidge = 0.01F;
constexpr float kWorst = std::numeric_limits<float>::infinity();

/// One of Choice's units and its dose.
struct Chosen {
  std::size_t unit = 0;
  float dose = kFirstDose;
};
struct Candidate {
  std::vector<Chosen> units;
  float cost = kWorst;
};

class Choice {
 public:
  Choice(const SeenFace& face, const std::vector<std::size_t>& opposite, const Evidence& evidence)
      : face_(face) {
    // Columns of a matrix that makes both sides of a unit one: pose and gaze, then units.
    std::vector<std::vector<Eigen::Index>> columns;
    for (Eigen::Index k = 0; k < kPose; ++k) columns.push_back({k});
    for (std::size_t c = 0; c < face.channels.size(); ++c) {
      const auto column = kPose + static_cast<Eigen::Index>(c);
      if (face.channels[c].kind != Channel::Kind::kUnit) {
        columns.push_back({column});
      } else if (opposite[c] >= face.channels.size()) {
        units_.push_back({c});
      } else if (opposite[c] > c) {
        units_.push_back({c, opposite[c]});
      }
    }
    free_ = columns.size();
    for (const auto& unit : units_) {
      auto& sides = columns.emplace_back();
      for (const std::size_t c : unit) sides.push_back(kPose + static_cast<Eigen::Index>(c));
    }
    Matrix join = Matrix::Zero(evidence.steps.rows(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      for (const Eigen::Index k : columns[i]) join(k, static_cast<Eigen::Index>(i)) = 1;
    }
    all_ = {.steps = join.transpose() * evidence.steps * join,
            .shared = evidence.shared * join,
            .variations = evidence.variations,
            .missed = join.transpose() * evidence.missed,
            .missed_ways = evidence.missed_ways};
    all_.steps.diagonal().head<kPose / 2>().array() += kSureOfTurn;
  }

  std::vector<float> From(const std::vector<float>& before) const {
    std::vector<Chosen> units;
    for (std::size_t u = 0; u < units_.size(); ++u) {
      float dose = 0;
      for (const std::size_t c : units_[u])
        dose += before[c] / static_cast<float>(units_[u].size());
      if (dose > kNoDose) units.push_back({u, std::min(dose, kMostDose)});
    }
    std::ranges::sort(units, std::greater{}, &Chosen::dose);
    if (units.size() > kMostUnits) units.resize(kMostUnits);
    Candidate best = BestFrom({});
    // From the units of the picture before, the search may end at a set that is likelier than its
    // neighbours and yet wrong; from none, at another one.
    if (!units.empty()) best = std::ranges::min(best, BestFrom(units), {}, &Candidate::cost);
    return DosesOf(best);
  }

 private:
  std::vector<float> DosesOf(const Candidate& candidate) const {
    std::vector<float> doses(face_.channels.size(), 0.0F);
    for (const Chosen& chosen : candidate.units) {
      for (const std::size_t c : units_[chosen.unit]) doses[c] = chosen.dose;
    }
    return doses;
  }

  /// Finds the doses of a candidate's units and what it costs: minus twice the logarithm of its
  /// likelihood, but for what all have alike.
  void Rate(Candidate& candidate, int rounds) const {
    std::vector<Eigen::Index> columns;
    for (std::size_t k = 0; k < free_; ++k) columns.push_back(static_cast<Eigen::Index>(k));
    for (const Chosen& chosen : candidate.units) {
      columns.push_back(static_cast<Eigen::Index>(free_ + chosen.unit));
    }
    const Matrix steps = all_.steps(columns, columns), shared = all_.shared(Eigen::all, columns);
    const Vector missed = all_.missed(columns);
    for (int round = 0; round < rounds; ++round) {
      const Vector sure = SureOfNone(face_, DosesOf(candidate));
      Matrix own = all_.variations;
      own.diagonal() += sure;
      const Eigen::LLT<Matrix> solver(own);
      const Vector alone = solver.solve(all_.missed_ways);
      Matrix left = steps - shared.transpose() * solver.solve(shared);
      const Vector wanted = missed - shared.transpose() * alone;
      Vector pull = wanted;
      float cost = 0;
      for (std::size_t u = 0; u < candidate.units.size(); ++u) {
        const auto i = static_cast<Eigen::Index>(free_ + u);
        const Chosen& chosen = candidate.units[u];
        const auto sides = static_cast<float>(units_[chosen.unit].size());
        const float sureness = std::sqrt(std::max(left(i, i), 0.0F) / sides);
        pull[i] -= kDearer * sides * DoseCost::Slope(sureness, chosen.dose);
        cost += 2 * kDearer * sides * DoseCost::Of(sureness, chosen.dose);
      }
      left.diagonal().array() += kRidge;
      const Vector found = left.llt().solve(pull);
      for (std::size_t u = 0; u < candidate.units.size(); ++u) {
        float& dose = candidate.units[u].dose;
        dose = std::min(found[static_cast<Eigen::Index>(free_ + u)], kMostDose);
        if (!(dose > 0)) {
          candidate.cost = kWorst;
          return;
        }
      }
      candidate.cost =
          found.dot(left * found) - 2 * found.dot(wanted) - all_.missed_ways.dot(alone) + cost +
          2 * solver.matrixLLT().diagonal().array().log().sum() - sure.array().log().sum();
    }
  }

  Candidate BestFrom(std::vector<Chosen> units) const {
    Candidate best{std::move(units), kWorst};
    Rate(best, kFinalRounds);
    for (int move = 0; move < kMostMoves && Move(best); ++move) {
    }
    return best;
  }

  /// To the best of all candidates that differ by one unit, if one is better.
  bool Move(Candidate& best) const {
    std::vector<Candidate> candidates;
    const auto consider = [&](std::vector<Chosen> units) {
      Candidate& candidate = candidates.emplace_back(Candidate{std::move(units), kWorst});
      Rate(candidate, 1);
    };
    const auto without = [&](std::size_t out) {
      std::vector<Chosen> units = best.units;
      units.erase(units.begin() + static_cast<std::ptrdiff_t>(out));
      return units;
    };
    for (std::size_t out = 0; out < best.units.size(); ++out) consider(without(out));
    for (std::size_t u = 0; u < units_.size(); ++u) {
      if (std::ranges::find(best.units, u, &Chosen::unit) != best.units.end()) continue;
      if (best.units.size() < kMostUnits) {
        std::vector<Chosen> more = best.units;
        more.push_back({u});
        consider(std::move(more));
      }
      for (std::size_t out = 0; out < best.units.size(); ++out) {
        std::vector<Chosen> other = without(out);
        other.push_back({u});
        consider(std::move(other));
      }
    }
    const std::size_t count = std::min(kFinalists, candidates.size());
    std::ranges::partial_sort(candidates, candidates.begin() + static_cast<std::ptrdiff_t>(count),
                              {}, &Candidate::cost);
    candidates.resize(count);
    for (Candidate& candidate : candidates) {
      if (candidate.cost < kWorst) Rate(candidate, kFinalRounds);
    }
    const auto found = std::ranges::min_element(candidates, {}, &Candidate::cost);
    if (found == candidates.end() || !(found->cost < best.cost)) return false;
    best = std::move(*found);
    return true;
  }

  const SeenFace& face_;
  std::vector<std::vector<std::size_t>> units_;  // channels of each unit's sides
  std::size_t free_ = 0;                         // columns of pose and gaze in all_
  Evidence all_;                                 // behind them a column for each of units_
};

}  // namespace

std::vector<float> ChooseUnits(const SeenFace& face, const std::vector<std::size_t>& opposite,
                               const Evidence& evidence, const std::vector<float>& before) {
  return Choice(face, opposite, evidence).From(before);
}

}  // namespace facetrack
