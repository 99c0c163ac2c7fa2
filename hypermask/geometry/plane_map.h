#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <vector>

namespace hypermask {

/// A point of a picture in pixels or of the mask in mm; x right, y down in both. The middle of the
/// first pixel is (0, 0).
using Point = Eigen::Vector2d;
using Points = std::vector<Point>;

/// How points of a plane lie in another one: a homography, up to its factor; affine ones have 0 0 1
/// as their last row.
using PlaneMap = Eigen::Matrix3d;

Point Apply(const PlaneMap& map, const Point& point);
Points Apply(const PlaneMap& map, const Points& points);

/// The homography that brings `from` nearest to `to`, by the normalised direct linear transform
/// (Hartley and Zisserman, Multiple View Geometry, algorithm 4.2). Nothing for less than four
/// points, or where three of four lie on a line. REQUIRES: as many of both.
std::optional<PlaneMap> FitHomography(const Points& from, const Points& to);
/// The affine map that brings them nearest, P C^T (C C^T)^-1 as in the HyperMask papers. Nothing
/// for less than three points, or where all lie on a line. REQUIRES: as many of both.
std::optional<PlaneMap> FitAffine(const Points& from, const Points& to);

/// The root of the mean squared distance of Apply(map, from) and `to`; 0 of none.
double RmsDistance(const PlaneMap& map, const Points& from, const Points& to);

/// Moves points so that their middle is 0 and their mean distance from it is sqrt(2), or sqrt(3) of
/// points in space: what direct linear transforms need to be well conditioned.
template <int N>
Eigen::Matrix<double, N + 1, N + 1> Normaliser(
    const std::vector<Eigen::Matrix<double, N, 1>>& points) {
  Eigen::Matrix<double, N, 1> middle = Eigen::Matrix<double, N, 1>::Zero();
  for (const auto& point : points) middle += point / static_cast<double>(points.size());
  double distance = 0;
  for (const auto& point : points) {
    distance += (point - middle).norm() / static_cast<double>(points.size());
  }
  const double scale = distance > 0 ? std::sqrt(static_cast<double>(N)) / distance : 1;
  Eigen::Matrix<double, N + 1, N + 1> map = Eigen::Matrix<double, N + 1, N + 1>::Identity();
  map.template topLeftCorner<N, N>() *= scale;
  map.template topRightCorner<N, 1>() = -scale * middle;
  return map;
}

}  // namespace hypermask
