#pragma once

#include <cstdint>
#include <vector>

#include "fsm/image/image.h"
#include "hypermask/base/grey.h"
#include "hypermask/base/mask_layout.h"
#include "hypermask/geometry/pinhole.h"

namespace hypermask {

/// A camera, a projector or an eye and where it stands.
struct Viewpoint {
  Pinhole lens{};
  Pose world{};  ///< the world's in the viewer's frame: x_viewer = rotation * x_world + position

  /// At `from`, looking at `to`, upright; mm of the world.
  static Viewpoint LookingAt(const Pinhole& lens, const Eigen::Vector3d& from,
                             const Eigen::Vector3d& to);
  /// How a plane that stands at `plane` in the world lies in its picture.
  PlaneMap Of(const Pose& plane) const;
};

/// The simulated room: a white plate with glowing markers before a curtain, a projector and a
/// camera beside it whose poses and lenses are known here and nowhere else. What is made of it is
/// the same on every run. Thread: one.
struct Stage {
  MaskLayout layout = MaskLayout::Default();
  Viewpoint projector, camera, audience;
  double curtain_z = 3300;    ///< mm
  double noise = 2.5;         ///< standard deviation of the camera's brightness, of 255
  double exposure_s = 0.004;  ///< markers are smeared over it
  Stage();
};

/// What the camera sees of the stage.
class StageCamera {
 public:
  explicit StageCamera(const Stage& stage);
  /// The `number`th picture. `hidden`: markers that are covered, a bit for each. `shown`: what is
  /// projected meanwhile, if the camera has no infrared filter; null: it has one.
  void See(const Pose& mask, const Pose& mask_later, std::uint32_t number, unsigned hidden,
           const fsm::Image* shown, Grey& out) const;

 private:
  void AddMarkers(const Pose& mask, double part, unsigned hidden, std::vector<float>& light) const;
  void AddProjected(const Pose& mask, const fsm::Image& shown, std::vector<float>& light) const;
  const Stage& stage_;
  std::vector<float> noise_;  // normal numbers, used in another order for each picture
};

/// What the audience sees of the stage with `shown` projected.
class StageView {
 public:
  explicit StageView(const Stage& stage);
  void See(const Pose& mask, const fsm::Image& shown, fsm::Image& out) const;

 private:
  const Stage& stage_;
  fsm::Image plate_;  // the mask's colour and shape in its plane
};

/// The plate's outline on the mask's plane, mm, clockwise.
Points PlateOutline(const MaskLayout& layout);

/// How far from where it should each of five points of the oval lands, pixels of the projector, if
/// the mask's plane (mm) is shown by `map` while it stands at `truth`.
std::vector<double> LandingDistances(const Stage& stage, const PlaneMap& map, const Pose& truth);

}  // namespace hypermask
