#include "fsm/head/anatomy.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "embedded/eye.h"
#include "embedded/mouth.h"

namespace fsm {

Curve ReadCurve(const Table& table, std::string_view x_key, std::string_view y_key) {
  const TableRow& x = table.Only(x_key);
  const TableRow& y = table.Only(y_key);
  std::vector<float> xs = x.Numbers(1);
  std::vector<float> ys = y.Numbers(1);
  if (xs.size() < 2) x.Refuse("a curve needs two points");
  if (xs.size() != ys.size()) {
    y.Refuse("has " + std::to_string(ys.size()) + " values, '" + x.key() + "' has " +
             std::to_string(xs.size()));
  }
  if (std::ranges::adjacent_find(xs, std::greater_equal<float>()) != xs.end()) {
    x.Refuse("must ascend");
  }
  return {std::move(xs), std::move(ys)};
}

const EyeAnatomy& EyeAnatomy::BuiltIn() {
  static const EyeAnatomy eye(Table("tables/eye.txt", embedded::eye()));
  return eye;
}

EyeAnatomy::EyeAnatomy(const Table& table)
    : lid_radius_(ReadCurve(table, "lid_radius", "lid_value")),
      upper_(ReadCurve(table, "upper_lid_x", "upper_lid_y")),
      lower_(ReadCurve(table, "lower_lid_x", "lower_lid_y")) {
  for (const bool outer : {false, true}) {
    const auto end = [&](const char* row) {
      const std::vector<float> all = table.Only(row).Numbers(1);
      return outer ? all.back() : all.front();
    };
    if (end("upper_lid_x") != end("lower_lid_x") || end("upper_lid_y") != end("lower_lid_y"))
      table.Only("lower_lid_y").Refuse("the lids must end in the same two corners");
  }
  const TableRow& ball = table.Only("ball");
  centre_ = ball.Vector(1);
  radius_ = ball.Number(4);
  if (radius_ <= 0) ball.Refuse("the radius must be positive");
  iris_ = table.Only("iris").Number(1);
  pupil_ = table.Only("iris").Number(2);
  shear_ = table.Only("lid_shear").Number(1);
  meet_sag_ = table.Only("meet_sag").Number(1);
  const TableRow& below = table.Only("below_fill");
  below_fill_ = below.Number(1);
  below_width_ = below.Number(2);
  if (below_width_ <= 0) below.Refuse("the width must be positive");
  for (const TableRow& row : table.RowsOf("lid_ring")) {
    lid_rings_.push_back({row.Number(1), row.Number(2), row.Number(3), row.Number(4), row.Number(5),
                          row.Number(6), row.Number(7), row.Number(8)});
  }
}

float EyeAnatomy::AngleOf(float x, float y) const {
  return std::asin(std::clamp((y - centre_.y) / LidRadius(x), -0.99f, 0.99f));
}

float EyeAnatomy::CorneaCentre() const {
  const float edge = 1.06f * iris_;
  return std::sqrt(radius_ * radius_ - edge * edge) -
         std::sqrt(step::kCorneaRadius * step::kCorneaRadius - edge * edge);
}

float EyeAnatomy::InnerRadius(float x) const {
  const float dx = x - centre_.x;
  const float ball = std::sqrt(std::max(0.0f, radius_ * radius_ - dx * dx));
  // The lids' axis recedes outward; the ball's axis does not.
  return std::min(LidRadius(x) - 0.6f, std::max(ball + 0.25f - shear_ * dx, LidRadius(x) - 2.6f));
}

float EyeAnatomy::MeetAngle(float x) const {
  const float along = std::clamp((x - inner_x()) / (outer_x() - inner_x()), 0.0f, 1.0f);
  const float straight = std::lerp(UpperY(inner_x()), UpperY(outer_x()), along);
  const float y = straight - 4 * meet_sag_ * along * (1 - along);
  return AngleOf(x, std::clamp(y, LowerY(x), UpperY(x)));
}

glm::vec3 EyeAnatomy::LidPoint(float x, float angle, float radius) const {
  return {x, centre_.y + radius * std::sin(angle), LidAxisZ(x) + radius * std::cos(angle)};
}

const MouthAnatomy& MouthAnatomy::BuiltIn() {
  static const MouthAnatomy mouth(Table("tables/mouth.txt", embedded::mouth()));
  return mouth;
}

MouthAnatomy::MouthAnatomy(const Table& table)
    : line_y_(ReadCurve(table, "line_x", "line_y")),
      line_z_(ReadCurve(table, "line_x", "line_z")),
      upper_(ReadCurve(table, "upper_x", "upper_y")),
      lower_(ReadCurve(table, "lower_x", "lower_y")) {
  corner_ = table.Only("corner").Vector(1);
  const auto full = [&](std::string_view key) {
    const TableRow& row = table.Only(key);
    std::vector<float> y = row.Numbers(1);
    if (y.size() < 2) row.Refuse("needs at least two values");
    std::vector<float> x;
    for (std::size_t i = 0; i < y.size(); ++i) {
      x.push_back(static_cast<float>(i) / static_cast<float>(y.size() - 1));
    }
    return Curve(x, y);
  };
  upper_full_ = full("upper_full");
  lower_full_ = full("lower_full");
  border_z_upper_ = table.Only("border_z").Number(1);
  border_z_lower_ = table.Only("border_z").Number(2);
  column_x_ = table.Only("column_x").Numbers(1);
  const auto teeth = [&](std::string_view key) {
    const TableRow& row = table.Only(key);
    if (row.Number(3) <= 0) row.Refuse("half the width must be positive");
    const float edge_y = LineY(0) - row.Number(4);
    return ToothArch{.front_z = LineZ(0) - row.Number(1),
                     .depth = row.Number(2),
                     .half_width = row.Number(3),
                     .edge_y = edge_y,
                     .root_y = edge_y + row.Number(5),
                     .middle_x = 0,
                     .slope = 0};
  };
  upper_teeth_ = teeth("upper_teeth");
  lower_teeth_ = teeth("lower_teeth");
  const auto pair = [&](std::string_view key) {
    return glm::vec2(table.Only(key).Number(1), table.Only(key).Number(2));
  };
  bag_bend_ = {.web_x = pair("bag_web"),
               .height = pair("bag_height"),
               .depth = pair("bag_depth"),
               .web_depth = table.Only("bag_web").Number(3),
               .width = table.Only("bag_width").Number(1)};
  for (const TableRow& row : table.RowsOf("bag_ring")) {
    bag_rings_.push_back(
        {row.Number(1), row.Number(2), row.Number(3), row.Number(4), row.Number(5)});
  }
}

glm::vec3 MouthAnatomy::VermilionPoint(Lip lip, float x, float share) const {
  const bool upper = lip == Lip::kUpper;
  const float height = BorderY(lip, x);
  const float thickness = std::abs(height);
  const float fade = thickness / std::abs(BorderY(lip, 0));
  const float border_z = (upper ? border_z_upper_ : border_z_lower_) * std::min(1.0f, fade);
  const float full = (upper ? upper_full_ : lower_full_)(share)*thickness;
  return {x, LineY(x) + height * share + (upper ? 0.12f : -0.12f) * full * (1 - share),
          LineZ(x) + border_z * share + full};
}

}  // namespace fsm
