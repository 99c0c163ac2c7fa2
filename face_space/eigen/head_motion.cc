#include "face_space/eigen/head_motion.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace facespace {
namespace {

constexpr int kRounds = 4;
constexpr double kLeastMove = 0.02;  // mm, root mean square
constexpr double kLeastSpread = 3;   // mm, of still markers beside a line

Eigen::Map<const Eigen::Matrix3Xd> FrameOf(const Eigen::MatrixXd& places, Eigen::Index frame) {
  return {places.col(frame).data(), 3, places.rows() / 3};
}

/// How far markers lie beside the line that passes nearest to them, root mean square.
double SpreadBesideLine(const Eigen::Matrix3Xd& places, const std::vector<Eigen::Index>& used) {
  Eigen::Matrix3Xd chosen = places(Eigen::all, used);
  chosen.colwise() -= chosen.rowwise().mean().eval();
  const Eigen::VectorXd sizes = Eigen::JacobiSVD<Eigen::Matrix3Xd>(chosen).singularValues();
  return sizes.size() < 2 ? 0 : sizes[1] / std::sqrt(static_cast<double>(used.size()));
}

Eigen::Index RestFrames(const Recording& recording, double rest_ms) {
  Eigen::Index frames = 1;
  while (frames < recording.frames() &&
         recording.ms[static_cast<std::size_t>(frames)] <= recording.ms[0] + rest_ms) {
    ++frames;
  }
  return frames;
}

/// All frames brought onto `rest`, then their distance from how this recording begins.
Eigen::MatrixXd MovesOf(const Recording& recording, const FaceAtRest& rest, double rest_ms) {
  Eigen::MatrixXd moves(recording.places.rows(), recording.frames());
  for (Eigen::Index t = 0; t < recording.frames(); ++t) {
    const auto frame = FrameOf(recording.places, t);
    const RigidMove back = FitRigid(frame, rest.places, rest.still);
    Eigen::Map<Eigen::Matrix3Xd> out(moves.col(t).data(), 3, frame.cols());
    out = (back.turn * frame).colwise() + back.shift;
  }
  const Eigen::VectorXd begin = moves.leftCols(RestFrames(recording, rest_ms)).rowwise().mean();
  moves.colwise() -= begin;
  return moves;
}

/// The markers that moved least: a third of them, and more if those lie on a line.
std::vector<Eigen::Index> Stillest(const FaceAtRest& rest, const std::vector<FaceMoves>& faces) {
  const Eigen::Index count = rest.places.cols();
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(count);
  for (const FaceMoves& face : faces) {
    for (Eigen::Index m = 0; m < count; ++m)
      moved[m] += face.moves.middleRows<3>(3 * m).squaredNorm();
  }
  std::vector<Eigen::Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order,
                           [&](Eigen::Index a, Eigen::Index b) { return moved[a] < moved[b]; });
  for (auto used = std::max<std::size_t>(4, order.size() / 3);; used += 2) {
    used = std::min(used, order.size());
    const std::vector<Eigen::Index> still(order.begin(),
                                          order.begin() + static_cast<std::ptrdiff_t>(used));
    if (used == order.size() || SpreadBesideLine(rest.places, still) > 4 * kLeastSpread)
      return still;
  }
}

vm::Result<std::vector<Eigen::Index>> Named(const Recording& first,
                                            const std::vector<std::string>& names) {
  std::vector<Eigen::Index> still;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(first.markers, name);
    if (found == first.markers.end()) {
      return vm::Fail(vm::Errc::kBadValue, fmt::format("{}: there is no marker '{}' that could be "
                                                       "still",
                                                       first.name, name.substr(0, 40)));
    }
    still.push_back(found - first.markers.begin());
  }
  if (still.size() < 3) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("{} still markers named, 3 or more expected", still.size()));
  }
  return still;
}

}  // namespace

RigidMove FitRigid(const Eigen::Ref<const Eigen::Matrix3Xd>& from,
                   const Eigen::Ref<const Eigen::Matrix3Xd>& to,
                   const std::vector<Eigen::Index>& used) {
  const Eigen::Matrix3Xd a = from(Eigen::all, used), b = to(Eigen::all, used);
  const Eigen::Vector3d a_mean = a.rowwise().mean(), b_mean = b.rowwise().mean();
  const Eigen::Matrix3d covariance = (b.colwise() - b_mean) * (a.colwise() - a_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1, 1, 1);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign[2] = -1;
  RigidMove move;
  move.turn = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  move.shift = b_mean - move.turn * a_mean;
  return move;
}

vm::Result<StillFaces> RemoveHeadMotion(const std::vector<Recording>& recordings,
                                        const RestSettings& settings) {
  const Recording& first = recordings.front();
  StillFaces out;
  FaceAtRest& rest = out.rest;
  rest.markers = first.markers;
  rest.places = FrameOf(first.places, 0);
  if (settings.still.empty()) {
    rest.still.resize(first.markers.size());
    std::iota(rest.still.begin(), rest.still.end(), 0);
  } else {
    auto named = Named(first, settings.still);
    if (!named) return std::unexpected(named.error());
    rest.still = std::move(*named);
  }
  if (SpreadBesideLine(rest.places, rest.still) < kLeastSpread) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("{}: the still markers lie on a line or in one place; the head's turn "
                    "cannot be told",
                    first.name));
  }
  for (int round = 0; round < kRounds; ++round) {
    // How the first recording begins, averaged once its frames lie on each other.
    Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, rest.places.cols());
    const Eigen::Index frames = RestFrames(first, settings.rest_ms);
    for (Eigen::Index t = 0; t < frames; ++t) {
      const auto frame = FrameOf(first.places, t);
      const RigidMove back = FitRigid(frame, rest.places, rest.still);
      sum += (back.turn * frame).colwise() + back.shift;
    }
    rest.places = sum / static_cast<double>(frames);
    out.faces.clear();
    for (const Recording& recording : recordings) {
      out.faces.push_back(
          {recording.name, recording.ms, MovesOf(recording, rest, settings.rest_ms)});
    }
    if (settings.still.empty() && round + 1 < kRounds) rest.still = Stillest(rest, out.faces);
  }
  double squares = 0, numbers = 0;
  for (const FaceMoves& face : out.faces) {
    squares += face.moves.squaredNorm();
    numbers += static_cast<double>(face.moves.size()) / 3;
  }
  if (std::sqrt(squares / numbers) < kLeastMove) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("{}: nothing moves beside the head (less than {} mm); expressions that "
                    "begin at rest expected",
                    first.name, kLeastMove));
  }
  return out;
}

}  // namespace facespace
