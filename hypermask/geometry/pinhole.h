#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hypermask/geometry/plane_map.h"

namespace hypermask {

/// A camera, or a projector, which is one with its light reversed: square pixels and no distortion.
struct Pinhole {
  int width = 0, height = 0;          ///< of its picture, pixels
  double focal = 0;                   ///< pixels
  double centre_x = 0, centre_y = 0;  ///< where the optical axis meets the picture, pixels

  /// One that sees `degrees` from below to above, about the middle of its picture.
  static Pinhole OfField(int width, int height, double degrees);
  Eigen::Matrix3d Matrix() const;
};

/// Where something stands: x_outside = rotation * x_inside + position. Axes x right, y down, z away
/// from the one who looks; mm.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

/// How the plane z = 0 of what stands at `plane` in the device's frame lies in its picture.
PlaneMap PlaneToPicture(const Pinhole& device, const Pose& plane);

/// Where the plane stands before the camera whose picture shows it by `map` (of mm to pixels):
/// map ~ K [r1 r2 t], the turn made a rotation by its singular values (Zhang 2000, appendix C).
/// Nothing if it lies behind the camera or has no size.
std::optional<Pose> PoseOfPlane(const Pinhole& camera, const PlaneMap& map);

/// From points in space to a picture, up to a factor.
using SpaceMap = Eigen::Matrix<double, 3, 4>;
Point Apply(const SpaceMap& map, const Eigen::Vector3d& point);
/// By the normalised direct linear transform (Hartley and Zisserman, algorithm 7.1, without its
/// last step). Nothing for less than six points, or if they lie in one plane. REQUIRES: as many of
/// both.
std::optional<SpaceMap> FitSpaceMap(const std::vector<Eigen::Vector3d>& from, const Points& to);

}  // namespace hypermask
