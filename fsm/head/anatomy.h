#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "fsm/base/side.h"
#include "fsm/base/spline.h"
#include "fsm/base/table_reader.h"
#include "fsm/rig/lid_rig.h"
#include "fsm/rig/skin_weights.h"
#include "fsm/rig/tooth_arch.h"

namespace fsm {

/// A ring of the cage around the eye: a row `lid_ring` of tables/eye.txt, which explains it.
struct LidRing {
  float upper_mm, lower_mm, upper_hold, lower_hold, to_orbit, upper_lift, lower_lift, fill;
};

/// A ring of the bag behind the lips: a row `bag_ring` of tables/mouth.txt, which explains it.
struct BagRing {
  float height, back, widen, web, lip_hold;
};

/// How the bag's rings bend towards its corners: rows `bag_...` of tables/mouth.txt.
struct BagBend {
  glm::vec2 web_x, height, depth;
  float web_depth, width;
};

/// The agent's left eye and its lids (tables/eye.txt); the right one is the mirror image. Angles
/// are in radians about the eyeball's horizontal axis, upward from straight ahead.
class EyeAnatomy {
 public:
  explicit EyeAnatomy(const Table& table);
  static const EyeAnatomy& BuiltIn();

  glm::vec3 centre() const { return centre_; }
  glm::vec3 CentreOf(Side side) const { return {SignOf(side) * centre_.x, centre_.y, centre_.z}; }
  float radius() const { return radius_; }
  float iris_radius() const { return iris_; }
  /// Scales iris and pupil by a factor.
  void ScaleIris(float by) {
    iris_ *= by;
    pupil_ *= by;
  }
  float pupil_radius() const { return pupil_; }
  /// Thickens the skin between the upper lid and the brow by this many millimetres.
  void FillUpperLid(float mm) { upper_fill_ += mm; }
  float upper_fill() const { return upper_fill_; }
  float below_fill() const { return below_fill_; }
  float below_width() const { return below_width_; }
  /// Returns the cornea's centre before the ball's, in mm, so that both meet at the limbus.
  float CorneaCentre() const;
  float inner_x() const { return upper_.begin_x(); }
  float outer_x() const { return upper_.end_x(); }

  /// LidRadius is the radius of the lids' surface of revolution at x, LidAxisZ the z of its axis
  /// there.
  float LidRadius(float x) const { return lid_radius_(x - centre_.x); }
  float LidAxisZ(float x) const { return centre_.z + shear_ * (x - centre_.x); }
  /// Returns a radius just outside the ball (the lids' wet inner edge), at most LidRadius - 0.6.
  float InnerRadius(float x) const;
  float UpperY(float x) const { return upper_(x); }
  float LowerY(float x) const { return lower_(x); }
  float UpperAngle(float x) const { return AngleOf(x, upper_(x)); }
  float LowerAngle(float x) const { return AngleOf(x, lower_(x)); }
  /// Returns the angle at which the closed lids meet.
  float MeetAngle(float x) const;
  glm::vec3 LidPoint(float x, float angle, float radius) const;
  const std::vector<LidRing>& lid_rings() const { return lid_rings_; }

 private:
  float AngleOf(float x, float y) const;
  glm::vec3 centre_{};
  float radius_ = 0, iris_ = 0, pupil_ = 0, shear_ = 0, meet_sag_ = 0, upper_fill_ = 0;
  float below_fill_ = 0, below_width_ = 1;  // row below_fill of tables/eye.txt
  Curve lid_radius_, upper_, lower_;
  std::vector<LidRing> lid_rings_;  // from the margin outward
};

/// The closed mouth (tables/mouth.txt): its left half over x = 0..corner, in millimetres.
class MouthAnatomy {
 public:
  explicit MouthAnatomy(const Table& table);
  static const MouthAnatomy& BuiltIn();

  glm::vec3 corner() const { return corner_; }
  float LineY(float x) const { return line_y_(x); }
  float LineZ(float x) const { return line_z_(x); }
  /// Height of the red over the line, negative on the lower lip; 0 beyond the corner.
  float BorderY(Lip lip, float x) const { return lip == Lip::kUpper ? upper_(x) : lower_(x); }
  const ToothArch& upper_teeth() const { return upper_teeth_; }
  const ToothArch& lower_teeth() const { return lower_teeth_; }
  /// Returns a point on the red of the lip; `share`: 0 = seam, 1 = vermilion border.
  glm::vec3 VermilionPoint(Lip lip, float x, float share) const;
  const std::vector<float>& column_x() const { return column_x_; }
  const std::vector<BagRing>& bag_rings() const { return bag_rings_; }
  const BagBend& bag_bend() const { return bag_bend_; }

 private:
  glm::vec3 corner_{};
  Curve line_y_, line_z_, upper_, lower_, upper_full_, lower_full_;
  float border_z_upper_ = 0, border_z_lower_ = 0;
  ToothArch upper_teeth_{}, lower_teeth_{};
  std::vector<float> column_x_;     // x of the cage's columns, from the median to the corner
  std::vector<BagRing> bag_rings_;  // from the end of the bag to the lips
  BagBend bag_bend_{};
};

/// Makes a curve of two rows of a table, `x_key` and `y_key`; throws naming the line if they do not
/// match.
Curve ReadCurve(const Table& table, std::string_view x_key, std::string_view y_key);

}  // namespace fsm
