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
constexpr float kFarTurn = 20;   // degrees at which points are off by all of their spread
constexpr int kRounds = 6;
constexpr float kShut = 0.5F;  // dose of unit 43 from which on an iris is not seen

/// The size of a dose that is nothing unusual.
float Usual(const Channel& channel) { return channel.kind == Channel::Kind::kUnit ? 1 : 20; }

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
  std::vector<float> misses(kPoints);
  for (int round = 0; round < kRounds; ++round) {
    const Points moved = Moved(face_, rest, doing.doses);
    const Eigen::Matrix3f turn = Of(doing.pose.turn);
    const float away = -doing.pose.place.z;
    // Beside the person's rest, what the network sees of a face turned alike is off alike.
    const float off_by_turn =
        what == What::kDoses ? std::min(glm::length(SeenTurn(doing.pose)) / kFarTurn, 1.5F) : 1;
    Matrix slopes(2 * kPoints, unknowns);
    Vector miss(2 * kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const glm::vec3 q = doing.pose(moved[i]);
      const float depth = -q.z;
      const glm::vec2 by =
          (places[i] - SeenAt(face_, lens_, doing.pose, i, moved[i])) * (away / lens_.focal);
      misses[i] = glm::length(by);
      const float sure = 1 / std::hypot(kUnsure, off_by_turn * face_.spread[i]);
      const bool hidden = i >= kIris && EyeIsShut(face_, doing.doses, i);
      const float off = misses[i] * sure;
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
      miss.segment<2>(row) = weight * Eigen::Vector2f(by.x, by.y);
    }
    Matrix normal = slopes.transpose() * slopes;
    Vector down = slopes.transpose() * miss;
    constexpr float kAny = 1e6F;
    Vector low = Vector::Constant(unknowns, -kAny), high = Vector::Constant(unknowns, kAny);
    for (int k = 0; k < kPose; ++k) normal(k, k) += 1e-3F;
    if (what == What::kDoses) low.head<3>().setZero(), high.head<3>().setZero();
    for (int c = 0; c < unknowns - kPose; ++c) {
      const Channel& channel = face_.channels[static_cast<std::size_t>(c)];
      const float dose = doing.doses[static_cast<std::size_t>(c)], usual = Usual(channel);
      const int k = kPose + c;
      normal(k, k) += kRidge / (usual * usual);
      down[k] -= kRidge * dose / (usual * usual);
      if (channel.kind == Channel::Kind::kUnit) down[k] -= kLean;
      const std::size_t other = opposite_[static_cast<std::size_t>(c)];
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
    if (by.head<3>().norm() < kStill && by.segment<3>(3).norm() < 0.05F && round > 2) break;
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
