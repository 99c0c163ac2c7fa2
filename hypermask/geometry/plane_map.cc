#include "hypermask/geometry/plane_map.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cassert>
#include <cmath>

namespace hypermask {

Point Apply(const PlaneMap& map, const Point& point) {
  return (map * point.homogeneous()).hnormalized();
}

Points Apply(const PlaneMap& map, const Points& points) {
  Points out;
  out.reserve(points.size());
  for (const Point& point : points) out.push_back(Apply(map, point));
  return out;
}

std::optional<PlaneMap> FitHomography(const Points& from, const Points& to) {
  assert(from.size() == to.size());
  if (from.size() < 4) return std::nullopt;
  const Eigen::Matrix3d from_scale = Normaliser<2>(from), to_scale = Normaliser<2>(to);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(from.size()), 9);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector3d x = from_scale * from[i].homogeneous();
    const Eigen::Vector3d y = to_scale * to[i].homogeneous();
    const auto row = 2 * static_cast<Eigen::Index>(i);
    a.block<1, 3>(row, 0) = x.transpose();
    a.block<1, 3>(row, 6) = -y.x() * x.transpose();
    a.block<1, 3>(row + 1, 3) = x.transpose();
    a.block<1, 3>(row + 1, 6) = -y.y() * x.transpose();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullV);
  // A second way to make A h small: the points do not fix a homography.
  constexpr double kLeast = 1e-7;
  if (!(svd.singularValues()[7] > kLeast * svd.singularValues()[0])) return std::nullopt;
  const Eigen::VectorXd h = svd.matrixV().col(8);
  PlaneMap map;
  map << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
  // One that lays the plane on a line: three points of a line came from three that are not.
  if (std::abs(map.determinant()) < kLeast) return std::nullopt;
  map = (to_scale.inverse() * map * from_scale).eval();
  const double factor = map(2, 2);
  if (!map.allFinite() || std::abs(factor) < 1e-12 * map.norm()) return std::nullopt;
  map /= factor;
  return map.allFinite() ? std::optional(map) : std::nullopt;
}

std::optional<PlaneMap> FitAffine(const Points& from, const Points& to) {
  assert(from.size() == to.size());
  if (from.size() < 3) return std::nullopt;
  const Eigen::Matrix3d from_scale = Normaliser<2>(from), to_scale = Normaliser<2>(to);
  Eigen::MatrixXd c(3, static_cast<Eigen::Index>(from.size()));
  Eigen::MatrixXd p(3, c.cols());
  for (std::size_t i = 0; i < from.size(); ++i) {
    c.col(static_cast<Eigen::Index>(i)) = from_scale * from[i].homogeneous();
    p.col(static_cast<Eigen::Index>(i)) = to_scale * to[i].homogeneous();
  }
  const Eigen::Matrix3d square = c * c.transpose();
  if (std::abs(square.determinant()) < 1e-9) return std::nullopt;
  PlaneMap map = to_scale.inverse() * (p * c.transpose() * square.inverse()) * from_scale;
  map.row(2) << 0, 0, 1;  // it is so but for rounding
  return map.allFinite() ? std::optional(map) : std::nullopt;
}

double RmsDistance(const PlaneMap& map, const Points& from, const Points& to) {
  assert(from.size() == to.size());
  if (from.empty()) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) sum += (Apply(map, from[i]) - to[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(from.size()));
}

}  // namespace hypermask
