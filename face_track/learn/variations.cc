#include "face_track/learn/variations.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iostream>

namespace facetrack {
namespace {

constexpr int kNumbers = 2 * kPoints;
constexpr Eigen::Index kVariations = 60;
constexpr float kLeastDose = 0.6F;  // of the usual one: of smaller doses little is seen

/// The points with channels of both sides at their greatest doses.
Points Opened(const SeenFace& face, std::initializer_list<const char*> channels) {
  Points points = face.rest;
  for (const char* name : channels) {
    const Channel& channel = face.channels[face.Find(name)];
    for (std::size_t i = 0; i < kPoints; ++i) points[i] += channel.motion.back()[i];
  }
  return points;
}

Eigen::VectorXd NumbersOf(const std::vector<glm::vec2>& points) {
  Eigen::VectorXd numbers(kNumbers);
  for (std::size_t i = 0; i < kPoints; ++i) {
    numbers[static_cast<Eigen::Index>(2 * i)] = points[i].x;
    numbers[static_cast<Eigen::Index>(2 * i + 1)] = points[i].y;
  }
  return numbers;
}

/// How heads differ in one channel, a column each, at a dose of Channel::usual().
Eigen::MatrixXd DifferencesOf(const std::vector<Eigen::MatrixXd>& by_dose, const Channel& channel) {
  Eigen::MatrixXd all(kNumbers, 0);
  for (std::size_t k = 0; k < channel.doses.size(); ++k) {
    const float size = std::abs(channel.doses[k]) / channel.usual();
    if (size < kLeastDose) continue;
    const Eigen::MatrixXd& seen = by_dose[k];
    const Eigen::Index before = all.cols();
    all.conservativeResize(Eigen::NoChange, before + seen.cols());
    all.rightCols(seen.cols()) = (seen.colwise() - seen.rowwise().mean()) / size;
  }
  return all;
}

}  // namespace

Mirroring Mirroring::Of(const SeenFace& face) {
  Mirroring mirroring;
  mirroring.points = MirroredPoints({face.rest, Opened(face, {"26"}), Opened(face, {"28"}),
                                     Opened(face, {"9L", "9R"}), Opened(face, {"43L", "43R"})});
  for (const Channel& channel : face.channels) {
    Channel other = channel;
    other.side = channel.side == "L" ? "R" : channel.side == "R" ? "L" : "";
    mirroring.channels.push_back(face.Find(other.Name()));
  }
  for (std::size_t i = 0; i < kPoints; ++i) {
    if (!mirroring.IsPaired(face, i)) {
      std::cerr << fmt::format("face_track_learn: point {} has no opposite; left as seen\n", i);
    }
  }
  return mirroring;
}

std::size_t Mirroring::Dose(const Channel& channel, std::size_t index) {
  return channel.kind == Channel::Kind::kGazeRight ? channel.doses.size() - 1 - index : index;
}

bool Mirroring::IsPaired(const SeenFace& face, std::size_t point) const {
  return points[point] != point || std::abs(face.rest[point].x) <= 3;
}

void Variations::Teach(const Mirroring& mirroring, SeenFace& to) const {
  std::vector<Eigen::MatrixXd> differences;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kNumbers, kNumbers);
  Eigen::Index count = 0;
  for (std::size_t c = 0; c < to.channels.size(); ++c) {
    const Channel& channel = to.channels[c];
    std::vector<Eigen::MatrixXd> by_dose;
    for (std::size_t k = 0; k < channel.doses.size(); ++k) {
      Eigen::MatrixXd& seen = by_dose.emplace_back(kNumbers, 2 * heads_.size());
      Eigen::Index column = 0;
      for (const Seen& head : heads_) {
        const auto& own = head[c][k];
        const auto& other = head[mirroring.channels[c]][Mirroring::Dose(channel, k)];
        std::vector<glm::vec2> mirrored = own;
        for (std::size_t i = 0; i < kPoints; ++i) {
          if (!mirroring.IsPaired(to, i)) continue;
          const glm::vec2 opposite = other[mirroring.points[i]];
          mirrored[i] = {-opposite.x, opposite.y};
        }
        seen.col(column++) = NumbersOf(own);
        seen.col(column++) = NumbersOf(mirrored);
      }
    }
    const auto& all = differences.emplace_back(DifferencesOf(by_dose, channel));
    covariance += all * all.transpose();
    count += all.cols();
  }
  covariance /= static_cast<double>(count);
  // Eigenvectors come with rising eigenvalues.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  Eigen::MatrixXd ways = solver.eigenvectors().rightCols(kVariations).rowwise().reverse();
  Eigen::VectorXd left = covariance.diagonal();
  for (Eigen::Index k = 0; k < kVariations; ++k) {
    const double variance = solver.eigenvalues()[kNumbers - 1 - k];
    left -= variance * ways.col(k).cwiseAbs2();
    Eigen::Index greatest = 0;
    ways.col(k).cwiseAbs().maxCoeff(&greatest);
    if (ways(greatest, k) < 0) ways.col(k) *= -1;  // either sign would do; one is written
  }
  const double scale = std::sqrt(static_cast<double>(kPoints));
  to.variations.assign(kVariations, {});
  for (Eigen::Index k = 0; k < kVariations; ++k) {
    for (Eigen::Index i = 0; i < kNumbers; i += 2) {
      to.variations[static_cast<std::size_t>(k)].emplace_back(scale * ways(i, k),
                                                              scale * ways(i + 1, k));
    }
  }
  to.remainder.clear();
  for (Eigen::Index i = 0; i < kNumbers; i += 2) {
    to.remainder.push_back(
        static_cast<float>(std::sqrt(std::max(0.5 * (left[i] + left[i + 1]), 0.0))));
  }
  for (std::size_t c = 0; c < to.channels.size(); ++c) {
    const Eigen::MatrixXd along = ways.transpose() * differences[c] / scale;
    to.channels[c].varies.clear();
    for (Eigen::Index k = 0; k < kVariations; ++k) {
      to.channels[c].varies.push_back(static_cast<float>(
          std::sqrt(along.row(k).squaredNorm() / static_cast<double>(along.cols()))));
    }
  }
}

}  // namespace facetrack
