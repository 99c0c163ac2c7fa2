#include "face_track/fit/frame_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "face_track/fit/bounded_solve.h"
#include "face_track/model/eigen_glm.h"

namespace facetrack {
namespace {

using Matrix = Eigen::MatrixXf;
using Vector = Eigen::VectorXf;

constexpr int kPose = 6;     // turn, place
constexpr float kHuber = 2;  // in parts of that and its spread
// Doses are drawn to 0 by their square and by their size, and to that of the other side.
constexpr float kRidge = 1, kLean = 5, kTogether = 100, kEyesTogether = 200;
constexpr float kUnsure = 0.3F;  // mm by which any point may be off
// Where the turn is known: likewise, beside what heads differ in; by how much each variation may be
// there without a unit, mm; the dose by which the first round takes the variations; how strongly
// doses up to what is small are drawn to 0, in parts of how surely each is seen.
constexpr float kUnsureOfDoses = 0.2F, kVariesAnyway = 0.005F, kFirstDose = 0.3F;
constexpr float kSparse = 1.2F, kSmallDose = 0.2F;
constexpr float kFarTurn = 20;  // degrees at which points are off by all of their spread
constexpr int kRounds = 6;
constexpr float kShut = 0.5F;  // dose of unit 43 from which on an iris is not seen

/// How surely each variation is not there: the inverse of its variance, by what doses there are.
Vector SureOfNone(const SeenFace& face, const std::vector<float>& doses, bool first) {
  Vector variance = Vector::Constant(static_cast<Eigen::Index>(face.variations.size()),
                                     kVariesAnyway * kVariesAnyway);
  for (std::size_t c = 0; c < doses.size(); ++c) {
    const Channel& channel = face.channels[c];
    const float part = first ? kFirstDose : doses[c] / channel.usual();
    const Eigen::Map<const Vector> varies(channel.varies.data(), variance.size());
    variance += part * part * varies.cwiseAbs2();
  }
  return variance.cwiseInverse();
}

bool EyeIsShut(const SeenFace& face, const std::vector<float>& doses, std::size_t iris) {
  return doses[face.Find(iris == kIris ? "43R" : "43L")] > kShut;
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
  const bool units = what != What::kPose;
  const auto channels = static_cast<int>(face_.channels.size());
  const int unknowns = kPose + (units ? channels : 0);
  Doing doing = start;
  // Only where the turn is known, a variation is none of the turn's.
  const auto variations =
      static_cast<Eigen::Index>(what == What::kDoses ? face_.variations.size() : 0);
  Vector varied = Vector::Zero(variations);  // by how much along each
  std::vector<float> misses(kPoints);
  for (int round = 0; round < kRounds; ++round) {
    const Points moved = Moved(face_, rest, doing.doses);
    const Eigen::Matrix3f turn = Of(doing.pose.turn);
    const float away = -doing.pose.place.z;
    // Beside the person's rest, what the network sees of a face turned alike is off alike.
    const float off_by_turn =
        what == What::kDoses ? std::min(glm::length(SeenTurn(doing.pose)) / kFarTurn, 1.5F) : 1;
    Matrix slopes(2 * kPoints, unknowns);
    Matrix ways(2 * kPoints, variations);
    Vector miss(2 * kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const glm::vec3 q = doing.pose(moved[i]);
      const float depth = -q.z;
      const glm::vec2 by =
          (places[i] - SeenAt(face_, lens_, doing.pose, i, moved[i])) * (away / lens_.focal);
      misses[i] = glm::length(by);
      glm::vec3 variation(0);
      for (Eigen::Index k = 0; k < variations; ++k) {
        variation += varied[k] * glm::vec3(face_.variations[static_cast<std::size_t>(k)][i], 0);
      }
      const glm::vec2 varies(doing.pose.turn * variation);
      const float unsure =
          variations > 0 ? std::hypot(kUnsureOfDoses, face_.remainder[i]) : kUnsure;
      const float sure = 1 / std::hypot(unsure, off_by_turn * face_.spread[i]);
      const bool hidden = i >= kIris && EyeIsShut(face_, doing.doses, i);
      const float off = glm::length(by - glm::vec2(varies.x, -varies.y)) * sure;
      const float weight = hidden ? 0 : sure * (off > kHuber ? std::sqrt(kHuber / off) : 1.0F);
      Eigen::Matrix<float, 2, 3> seen;
      seen << 1, 0, q.x / depth, 0, -1, -q.y / depth;
      seen *= weight * away / depth;
      const auto row = static_cast<Eigen::Index>(2 * i);
      const Eigen::Vector3f arm = turn * Of(moved[i]);
      Eigen::Matrix3f cross;
      cross << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
      slopes.block<2, 3>(row, 0) = seen * cross;
      slopes.block<2, 3>(row, 3) = seen;
      if (units) {
        const Eigen::Matrix<float, 2, 3> by_place = seen * turn;
        for (int c = 0; c < channels; ++c) {
          const auto k = static_cast<std::size_t>(c);
          slopes.block<2, 1>(row, kPose + c) =
              by_place * Of(face_.channels[k].Slope(i, doing.doses[k]));
        }
      }
      for (Eigen::Index k = 0; k < variations; ++k) {
        const glm::vec2 way = face_.variations[static_cast<std::size_t>(k)][i];
        ways.block<2, 1>(row, k) = seen * turn.leftCols<2>() * Eigen::Vector2f(way.x, way.y);
      }
      miss.segment<2>(row) = weight * Eigen::Vector2f(by.x, by.y);
    }
    Matrix normal = slopes.transpose() * slopes;
    Vector down = slopes.transpose() * miss;
    // Variations have no bounds, so they are solved for by themselves (the Schur complement).
    const Matrix shared = ways.transpose() * slopes;
    const Vector along = ways.transpose() * miss;
    Eigen::LDLT<Matrix> own;
    if (variations > 0) {
      Matrix ways_normal = ways.transpose() * ways;
      ways_normal.diagonal() += SureOfNone(face_, doing.doses, round == 0);
      own.compute(ways_normal);
      normal -= shared.transpose() * own.solve(shared);
      down -= shared.transpose() * own.solve(along);
    }
    constexpr float kAny = 1e6F;
    Vector low = Vector::Constant(unknowns, -kAny), high = Vector::Constant(unknowns, kAny);
    const Vector sureness = normal.diagonal().cwiseMax(0.0F).cwiseSqrt();
    for (int k = 0; k < kPose; ++k) normal(k, k) += 1e-3F;
    if (what == What::kDoses) low.head<3>().setZero(), high.head<3>().setZero();
    for (int c = 0; c < unknowns - kPose; ++c) {
      const Channel& channel = face_.channels[static_cast<std::size_t>(c)];
      const float dose = doing.doses[static_cast<std::size_t>(c)], usual = channel.usual();
      const int k = kPose + c;
      normal(k, k) += kRidge / (usual * usual);
      down[k] -= kRidge * dose / (usual * usual);
      const std::size_t other = opposite_[static_cast<std::size_t>(c)];
      if (channel.kind == Channel::Kind::kUnit) {
        const float both = other == kNone ? dose : 0.5F * (dose + doing.doses[other]);
        const bool sparse = variations > 0 && round > 0;
        down[k] -= sparse ? kSparse * sureness[k] * kSmallDose / (kSmallDose + both) : kLean;
      }
      if (other != kNone) {
        const float together =
            (channel.kind == Channel::Kind::kUnit ? kTogether : kEyesTogether) / (usual * usual);
        normal(k, k) += together;
        normal(k, kPose + static_cast<int>(other)) -= together;
        down[k] -= together * (dose - doing.doses[other]);
      }
      low[k] = channel.lowest() - dose;
      high[k] = channel.highest() - dose;
    }
    const Vector by = BoundedSolve(normal, down, low, high);
    if (variations > 0) varied = own.solve(along - shared * by);
    const Eigen::Vector3f axis = by.head<3>();
    if (axis.norm() > 0) {
      doing.pose.turn =
          Back(Eigen::AngleAxisf(axis.norm(), axis.normalized()).toRotationMatrix() * turn);
    }
    doing.pose.place += glm::vec3(by[3], by[4], by[5]);
    doing.pose.place.z = std::min(doing.pose.place.z, -150.0F);
    for (int c = 0; c < unknowns - kPose; ++c) {
      const auto k = static_cast<std::size_t>(c);
      const Channel& channel = face_.channels[k];
      doing.doses[k] =
          std::clamp(doing.doses[k] + by[kPose + c], channel.lowest(), channel.highest());
    }
    constexpr float kStill = 2e-4F;
    const bool still = by.head<3>().norm() < kStill && by.segment<3>(3).norm() < 0.05F;
    if (still && round > 2 && variations == 0) break;
  }
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
