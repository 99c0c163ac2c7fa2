#include "fsm/mesh/transfer/drive_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fsm {
namespace {

constexpr float kMinGain = 5e-3f;  // drivers with less effect at full strength are dropped

/// The range of a parameter in speech, which moves the mouth less than a hand may (kMouthAtFull):
/// millimetres, degrees for the jaw's opening.
constexpr float SpeechRangeOf(std::size_t parameter) { return parameter == kJawY ? 10.0f : 4.0f; }

/// Solves a x = b for a symmetric positive definite `a` by Cholesky's decomposition; `b` becomes x.
void SolvePositive(std::vector<std::vector<double>>& a, std::vector<std::vector<double>>& b) {
  const std::size_t n = a.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
    }
  }
  const std::size_t columns = b.front().size();
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) b[i][c] -= a[i][k] * b[k][c];
      b[i][c] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) b[i][c] -= a[k][i] * b[k][c];
      b[i][c] /= a[i][i];
    }
  }
}

}  // namespace

void DriveFit::Add(std::size_t shape, const Drive& drive, float gain) {
  drivers_[shape].push_back({drive, gain});
}

void DriveFit::AddSided(const Drive& drive, float full,
                        const std::function<Weights(const Sided<bool>& raised)>& weights) {
  const Weights right = weights({.right = true}), left = weights({.left = true}),
                both = weights({true, true});
  for (std::size_t k = 0; k < drivers_.size(); ++k) {
    // w = a max(r, l) + b r + c l satisfies all three.
    const std::array<std::pair<Drive::WhichSide, float>, 3> parts{
        {{Drive::WhichSide::kStronger, right[k] + left[k] - both[k]},
         {Drive::WhichSide::kRight, both[k] - left[k]},
         {Drive::WhichSide::kLeft, both[k] - right[k]}}};
    for (const auto& [side, gain] : parts) {
      Drive sided = drive;
      sided.side = side;
      if (std::abs(gain) > kMinGain) Add(k, sided, gain / full);
    }
  }
}

MouthFit::Halves MouthFit::Split(const std::array<float, kMouthParameters>& mouth) {
  Halves halves{};
  for (std::size_t p = 0; p < kMouthParameters; ++p) {
    halves[p] = static_cast<double>(std::max(mouth[p], 0.0f) / SpeechRangeOf(p));
    halves[kMouthParameters + p] =
        static_cast<double>(std::max(-mouth[p], 0.0f) / SpeechRangeOf(p));
  }
  return halves;
}

void MouthFit::AddParameters(const std::function<Weights(const FaceState&)>& weights) {
  for (std::size_t half = 0; half < kHalves; ++half) {
    const std::size_t parameter = half % kMouthParameters;
    FaceState state;
    state.mouth[parameter] =
        half < kMouthParameters ? SpeechRangeOf(parameter) : -SpeechRangeOf(parameter);
    const Weights own = weights(state);
    for (std::size_t k = 0; k < gain_.size(); ++k) gain_[k][half] = static_cast<double>(own[k]);
  }
}

void MouthFit::AddViseme(const std::array<float, kMouthParameters>& mouth, Weights weights) {
  known_.push_back({mouth, std::move(weights)});
}

/// The normal equations of the change of the gains: square * change = wanted, by half and shape.
struct MouthFit::Equations {
  std::vector<std::vector<double>> square, wanted;
};

void MouthFit::AddEquation(const KnownMouth& viseme, double importance,
                           Equations& equations) const {
  const Halves halves = Split(viseme.mouth);
  for (std::size_t i = 0; i < kHalves; ++i) {
    if (halves[i] == 0) continue;
    for (std::size_t j = 0; j < kHalves; ++j) {
      equations.square[i][j] += importance * halves[i] * halves[j];
    }
  }
  for (std::size_t k = 0; k < gain_.size(); ++k) {
    double rest = static_cast<double>(viseme.weights[k]);
    for (std::size_t i = 0; i < kHalves; ++i) rest -= halves[i] * gain_[k][i];
    for (std::size_t i = 0; i < kHalves; ++i) {
      equations.wanted[i][k] += importance * halves[i] * rest;
    }
  }
}

void MouthFit::AddTo(DriveFit& fit, Drive::Kind kind) const {
  constexpr double kDamping = 1e-3, kBetween = 0.01;  // the weight of mouths between visemes
  Equations equations{.square{kHalves, std::vector<double>(kHalves, 0)},
                      .wanted{kHalves, std::vector<double>(gain_.size(), 0)}};
  for (std::size_t i = 0; i < kHalves; ++i) equations.square[i][i] = kDamping;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    AddEquation(known_[i], 1, equations);
    for (std::size_t j = 0; j < i; ++j) {
      KnownMouth mean = known_[i];
      for (std::size_t p = 0; p < kMouthParameters; ++p) {
        mean.mouth[p] = 0.5f * (mean.mouth[p] + known_[j].mouth[p]);
      }
      for (std::size_t k = 0; k < gain_.size(); ++k) {
        mean.weights[k] = 0.5f * (mean.weights[k] + known_[j].weights[k]);
      }
      AddEquation(mean, kBetween, equations);
    }
  }
  SolvePositive(equations.square, equations.wanted);
  for (std::size_t k = 0; k < gain_.size(); ++k) {
    for (std::size_t half = 0; half < kHalves; ++half) {
      const std::size_t parameter = half % kMouthParameters;
      const auto gain = static_cast<float>(gain_[k][half] + equations.wanted[half][k]);
      if (std::abs(gain) < kMinGain) continue;
      fit.Add(k,
              {.kind = kind,
               .number = static_cast<std::uint16_t>(parameter),
               .half = half < kMouthParameters ? Drive::Half::kPositive : Drive::Half::kNegative},
              gain / SpeechRangeOf(parameter));
    }
  }
}

}  // namespace fsm
