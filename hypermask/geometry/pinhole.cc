#include "hypermask/geometry/pinhole.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cassert>
#include <cmath>
#include <numbers>

namespace hypermask {

Pinhole Pinhole::OfField(int width, int height, double degrees) {
  return {.width = width,
          .height = height,
          .focal = 0.5 * height / std::tan(degrees * std::numbers::pi / 360),
          .centre_x = 0.5 * (width - 1),
          .centre_y = 0.5 * (height - 1)};
}

Eigen::Matrix3d Pinhole::Matrix() const {
  Eigen::Matrix3d k;
  k << focal, 0, centre_x, 0, focal, centre_y, 0, 0, 1;
  return k;
}

PlaneMap PlaneToPicture(const Pinhole& device, const Pose& plane) {
  Eigen::Matrix3d basis;
  basis << plane.rotation.col(0), plane.rotation.col(1), plane.position;
  return device.Matrix() * basis;
}

std::optional<Pose> PoseOfPlane(const Pinhole& camera, const PlaneMap& map) {
  Eigen::Matrix3d basis = camera.Matrix().inverse() * map;
  const double size = 0.5 * (basis.col(0).norm() + basis.col(1).norm());
  if (!(size > 0) || !basis.allFinite()) return std::nullopt;
  basis /= basis(2, 2) < 0 ? -size : size;
  Eigen::Matrix3d turn;
  turn << basis.col(0), basis.col(1), basis.col(0).cross(basis.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turn, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Pose pose{svd.matrixU() * svd.matrixV().transpose(), basis.col(2)};
  if (!(pose.position.z() > 0) || pose.rotation.determinant() < 0) return std::nullopt;
  return pose;
}

Point Apply(const SpaceMap& map, const Eigen::Vector3d& point) {
  return (map * point.homogeneous()).hnormalized();
}

std::optional<SpaceMap> FitSpaceMap(const std::vector<Eigen::Vector3d>& from, const Points& to) {
  assert(from.size() == to.size());
  if (from.size() < 6) return std::nullopt;
  const Eigen::Matrix4d from_scale = Normaliser<3>(from);
  const Eigen::Matrix3d to_scale = Normaliser<2>(to);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(from.size()), 12);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector4d x = from_scale * from[i].homogeneous();
    const Eigen::Vector3d y = to_scale * to[i].homogeneous();
    const auto row = 2 * static_cast<Eigen::Index>(i);
    a.block<1, 4>(row, 0) = x.transpose();
    a.block<1, 4>(row, 8) = -y.x() * x.transpose();
    a.block<1, 4>(row + 1, 4) = x.transpose();
    a.block<1, 4>(row + 1, 8) = -y.y() * x.transpose();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeFullV);
  constexpr double kLeast = 1e-6;
  if (!(svd.singularValues()[10] > kLeast * svd.singularValues()[0])) return std::nullopt;
  const Eigen::VectorXd m = svd.matrixV().col(11);
  SpaceMap map;
  map << m.segment<4>(0).transpose(), m.segment<4>(4).transpose(), m.segment<4>(8).transpose();
  map = (to_scale.inverse() * map * from_scale).eval();
  if (!map.allFinite() || !(map.norm() > 0)) return std::nullopt;
  // Points before the camera get a positive third number.
  const double sign = (map * from[0].homogeneous()).z() < 0 ? -1 : 1;
  map *= sign / map.row(2).head<3>().norm();
  return map.allFinite() ? std::optional(map) : std::nullopt;
}

}  // namespace hypermask
