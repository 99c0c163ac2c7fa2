#include "face_track/fit/frame_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <utility>

#include "face_track/fit/bounded_solve.h"
#include "face_track/fit/dose_prior.h"
#include "face_track/fit/unit_choice.h"
#include "face_track/model/eigen_glm.h"

namespace facetrack {
namespace {

using Matrix = Eigen::MatrixXf;
using Vector = Eigen::VectorXf;

constexpr int kPose = Evidence::kPose;
constexpr float kHuber = 2;  // in parts of that and its spread
// Doses are drawn to 0 by their square and by their size, and to that of the other side.
constexpr float kRidge = 0.2F, kLean = 5, kTogether = 100, kEyesTogether = 200;
constexpr float kUnsure = 0.3F;         // mm by which any point may be off
constexpr float kUnsureOfDoses = 0.3F;  // likewise, beside what heads differ in, of a known turn
constexpr float kFarTurn = 20;          // degrees at which points are off by all of their spread
constexpr int kRounds = 6;
constexpr float kAny = 1e6F;      // no bound
constexpr float kNearest = -150;  // mm, along the line of sight
constexpr float kShut = 0.5F;     // dose of unit 43 from which on an iris is not seen

bool EyeIsShut(const SeenFace& face, const std::vector<float>& doses, std::size_t iris) {
  return doses[face.Find(iris == kIris ? "43R" : "43L")] > kShut;
}

/// What a small step from a state changes in the picture: two rows a point, in parts of how surely
/// it is seen.
struct Equations {
  Matrix slopes;              // by pose and doses
  Matrix ways;                // by the variations
  Vector miss;                // what is wanted
  std::vector<float> misses;  // mm by which each point lies elsewhere
};

/// Normal equations of a step within bounds.
struct Normal {
  Matrix matrix;
  Vector down, low, high;
};

/// One round of the fit, in parts.
struct Fitting {
  const SeenFace& face;
  const Lens& lens;
  const std::vector<std::size_t>& opposite;  // as FrameFit's

  Equations EquationsAt(const Points& rest, std::span<const glm::vec2> places, const Doing& doing,
                        const Vector& varied, FrameFit::What what) const;
  void Choose(const Points& rest, std::span<const glm::vec2> places, Doing& doing) const;
  void Draw(Normal& normal, const Doing& doing, bool sparse) const;
  void Move(Doing& doing, const Vector& by) const;
};

Equations Fitting::EquationsAt(const Points& rest, std::span<const glm::vec2> places,
                               const Doing& doing, const Vector& varied,
                               FrameFit::What what) const {
  const int channels = what != FrameFit::What::kPose ? static_cast<int>(face.channels.size()) : 0;
  const Points moved = Moved(face, rest, doing.doses);
  const Eigen::Matrix3f turn = Of(doing.pose.turn);
  const float away = -doing.pose.place.z;
  // Beside the person's rest, what the network sees of a face turned alike is off alike.
  const float off_by_turn = what == FrameFit::What::kDoses
                                ? std::min(glm::length(SeenTurn(doing.pose)) / kFarTurn, 1.5F)
                                : 1;
  Equations equations{.slopes = Matrix(2 * kPoints, kPose + channels),
                      .ways = Matrix(2 * kPoints, varied.size()),
                      .miss = Vector(2 * kPoints),
                      .misses = std::vector<float>(kPoints)};
  for (std::size_t i = 0; i < kPoints; ++i) {
    const glm::vec3 q = doing.pose(moved[i]);
    const float depth = -q.z;
    const glm::vec2 by =
        (places[i] - SeenAt(face, lens, doing.pose, i, moved[i])) * (away / lens.focal);
    equations.misses[i] = glm::length(by);
    glm::vec3 variation(0);
    for (Eigen::Index k = 0; k < varied.size(); ++k) {
      variation += varied[k] * glm::vec3(face.variations[static_cast<std::size_t>(k)][i], 0);
    }
    const glm::vec2 varies(doing.pose.turn * variation);
    const float unsure =
        varied.size() > 0 ? std::hypot(kUnsureOfDoses, face.remainder[i]) : kUnsure;
    const float sure = 1 / std::hypot(unsure, off_by_turn * face.spread[i]);
    const bool hidden = i >= kIris && EyeIsShut(face, doing.doses, i);
    const float off = glm::length(by - glm::vec2(varies.x, -varies.y)) * sure;
    const float weight = hidden ? 0 : sure * (off > kHuber ? std::sqrt(kHuber / off) : 1.0F);
    Eigen::Matrix<float, 2, 3> seen;
    seen << 1, 0, q.x / depth, 0, -1, -q.y / depth;
    seen *= weight * away / depth;
    const auto row = static_cast<Eigen::Index>(2 * i);
    const Eigen::Vector3f arm = turn * Of(moved[i]);
    Eigen::Matrix3f cross;
    cross << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
    equations.slopes.block<2, 3>(row, 0) = seen * cross;
    equations.slopes.block<2, 3>(row, 3) = seen;
    const Eigen::Matrix<float, 2, 3> by_place = seen * turn;
    for (int c = 0; c < channels; ++c) {
      const auto k = static_cast<std::size_t>(c);
      equations.slopes.block<2, 1>(row, kPose + c) =
          by_place * Of(face.channels[k].Slope(i, doing.doses[k]));
    }
    for (Eigen::Index k = 0; k < varied.size(); ++k) {
      const glm::vec2 way = face.variations[static_cast<std::size_t>(k)][i];
      equations.ways.block<2, 1>(row, k) =
          seen * turn.leftCols<2>() * Eigen::Vector2f(way.x, way.y);
    }
    equations.miss.segment<2>(row) = weight * Eigen::Vector2f(by.x, by.y);
  }
  return equations;
}

Evidence EvidenceOf(const Equations& equations) {
  const auto& [slopes, ways, miss, _] = equations;
  return {.steps = slopes.transpose() * slopes,
          .shared = ways.transpose() * slopes,
          .variations = ways.transpose() * ways,
          .missed = slopes.transpose() * miss,
          .missed_ways = ways.transpose() * miss};
}

/// Puts the units in place of those there are that explain the picture best by themselves.
void Fitting::Choose(const Points& rest, std::span<const glm::vec2> places, Doing& doing) const {
  const auto is_unit = [&](std::size_t c) { return face.channels[c].kind == Channel::Kind::kUnit; };
  const std::vector<float> before = doing.doses;
  for (std::size_t c = 0; c < before.size(); ++c) {
    if (is_unit(c)) doing.doses[c] = 0;
  }
  const Vector varied = Vector::Zero(static_cast<Eigen::Index>(face.variations.size()));
  const Equations all = EquationsAt(rest, places, doing, varied, FrameFit::What::kDoses);
  const auto chosen = ChooseUnits(face, opposite, EvidenceOf(all), before);
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    if (is_unit(c)) doing.doses[c] = chosen[c];
  }
}

/// Draws doses to 0 and to those of the other side, and keeps them within their ranges. `sparse`:
/// small doses more than large ones.
void Fitting::Draw(Normal& normal, const Doing& doing, bool sparse) const {
  const Vector sureness = normal.matrix.diagonal().cwiseMax(0.0F).cwiseSqrt();
  for (int k = 0; k < kPose; ++k) normal.matrix(k, k) += 1e-3F;
  for (int k = kPose; k < normal.down.size(); ++k) {
    const auto c = static_cast<std::size_t>(k - kPose);
    const Channel& channel = face.channels[c];
    const float dose = doing.doses[c], usual = channel.usual();
    normal.matrix(k, k) += kRidge / (usual * usual);
    normal.down[k] -= kRidge * dose / (usual * usual);
    const std::size_t other = opposite[c];
    if (channel.kind == Channel::Kind::kUnit) {
      const float both = other == FrameFit::kNone ? dose : 0.5F * (dose + doing.doses[other]);
      normal.down[k] -= sparse ? DoseCost::Slope(sureness[k], both) : kLean;
    }
    if (other != FrameFit::kNone) {
      const float together =
          (channel.kind == Channel::Kind::kUnit ? kTogether : kEyesTogether) / (usual * usual);
      normal.matrix(k, k) += together;
      normal.matrix(k, kPose + static_cast<int>(other)) -= together;
      normal.down[k] -= together * (dose - doing.doses[other]);
    }
    normal.low[k] = channel.lowest() - dose;
    normal.high[k] = channel.highest() - dose;
  }
}

/// The state after a step.
void Fitting::Move(Doing& doing, const Vector& by) const {
  const Eigen::Vector3f axis = by.head<3>();
  if (axis.norm() > 0) {
    doing.pose.turn = Back(Eigen::AngleAxisf(axis.norm(), axis.normalized()).toRotationMatrix() *
                           Of(doing.pose.turn));
  }
  doing.pose.place += glm::vec3(by[3], by[4], by[5]);
  doing.pose.place.z = std::min(doing.pose.place.z, kNearest);
  for (std::size_t c = 0; c + kPose < static_cast<std::size_t>(by.size()); ++c) {
    const Channel& channel = face.channels[c];
    doing.doses[c] = std::clamp(doing.doses[c] + by[static_cast<Eigen::Index>(c) + kPose],
                                channel.lowest(), channel.highest());
  }
}

/// Radians about each axis by which a pose is turned from another, if it is little.
Vector TurnedFrom(const Pose& from, const Pose& to) {
  const Eigen::AngleAxisf by(Of(to.turn) * Of(from.turn).transpose());
  return by.angle() * by.axis();
}

}  // namespace

Points Moved(const SeenFace& face, const Points& rest, const std::vector<float>& doses) {
  Points moved = rest;
  for (std::size_t c = 0; c < doses.size(); ++c) {
    if (doses[c] == 0) continue;
    for (std::size_t i = 0; i < kPoints; ++i) moved[i] += face.channels[c].At(i, doses[c]);
  }
  return moved;
}

FrameFit::FrameFit(const SeenFace& face, const Lens& lens) : face_(face), lens_(lens) {
  for (const Channel& channel : face.channels) {
    Channel name;
    name.kind = channel.kind, name.unit = channel.unit, name.side = channel.side;
    name.side = name.side == "L" ? "R" : name.side == "R" ? "L" : "none";
    const auto at = std::ranges::find(face.channels, name.Name(), &Channel::Name);
    opposite_.push_back(
        at == face.channels.end() ? kNone : static_cast<std::size_t>(at - face.channels.begin()));
  }
}

Doing FrameFit::Guess(std::span<const glm::vec2> places) const {
  using namespace facefit::point;
  const glm::vec2 right = places[kEyeOuterRight], left = places[kEyeOuterLeft];
  const glm::vec2 across = left - right;
  const float away = lens_.focal * SeenFace::kEyesApart / std::max(glm::length(across), 1.0F);
  Doing doing;
  doing.doses.assign(face_.channels.size(), 0);
  doing.pose.turn = TurnOf({0, 0, glm::degrees(std::atan2(across.y, across.x))});
  const glm::vec3 eyes = 0.5F * (face_.rest[kEyeOuterRight] + face_.rest[kEyeOuterLeft]);
  doing.pose.place = lens_.Unproject(0.5F * (right + left), -away) - doing.pose.turn * eyes;
  return doing;
}

Doing FrameFit::Solve(const Points& rest, std::span<const glm::vec2> places, const Doing& start,
                      What what) const {
  const Fitting fitting{face_, lens_, opposite_};
  Doing doing = start;
  // Only where the turn is known, a variation is none of the turn's.
  const bool varies = what == What::kDoses && !face_.variations.empty();
  // By how much along each.
  Vector varied = Vector::Zero(varies ? static_cast<Eigen::Index>(face_.variations.size()) : 0);
  if (varies) fitting.Choose(rest, places, doing);
  std::vector<float> misses;
  for (int round = 0; round < kRounds; ++round) {
    Equations equations = fitting.EquationsAt(rest, places, doing, varied, what);
    const Evidence evidence = EvidenceOf(equations);
    Normal normal{.matrix = evidence.steps,
                  .down = evidence.missed,
                  .low = Vector::Constant(evidence.missed.size(), -kAny),
                  .high = Vector::Constant(evidence.missed.size(), kAny)};
    if (what == What::kDoses) {
      const Vector turned = TurnedFrom(start.pose, doing.pose);
      normal.matrix.diagonal().head<3>().array() += kSureOfTurn;
      normal.down.head<3>() -= kSureOfTurn * turned;
    }
    // Variations have no bounds, so they are solved for by themselves (the Schur complement).
    const Matrix& shared = evidence.shared;
    const Vector& along = evidence.missed_ways;
    Eigen::LDLT<Matrix> own;
    if (varies) {
      Matrix ways_normal = evidence.variations;
      ways_normal.diagonal() += SureOfNone(face_, doing.doses);
      own.compute(ways_normal);
      normal.matrix -= shared.transpose() * own.solve(shared);
      normal.down -= shared.transpose() * own.solve(along);
    }
    fitting.Draw(normal, doing, varies);
    const Vector by = BoundedSolve(normal.matrix, normal.down, normal.low, normal.high);
    if (varies) varied = own.solve(along - shared * by);
    fitting.Move(doing, by);
    misses = std::move(equations.misses);
    constexpr float kStill = 2e-4F;
    const bool still = by.head<3>().norm() < kStill && by.segment<3>(3).norm() < 0.05F;
    if (still && round > 2 && !varies) break;
  }
  if (what == What::kDoses) doing.pose.turn = start.pose.turn;
  std::ranges::nth_element(misses, misses.begin() + kPoints / 2);
  doing.miss = misses[kPoints / 2];
  return doing;
}

Points FrameFit::OnFace(const Points& rest, std::span<const glm::vec2> places,
                        const Doing& doing) const {
  const Points moved = Moved(face_, rest, doing.doses);
  Points found;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const glm::vec3 q = doing.pose(moved[i]);
    // The slide is where the network errs: it is taken off in the picture.
    const glm::vec2 slid = SeenAt(face_, lens_, doing.pose, i, moved[i]) - lens_.Project(q);
    found.push_back(doing.pose.Inverse(lens_.Unproject(places[i] - slid, q.z)));
  }
  return found;
}

}  // namespace facetrack
