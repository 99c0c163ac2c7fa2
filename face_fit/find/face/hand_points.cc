#include "face_fit/find/face/hand_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "face_fit/find/face/coinciding_corners.h"
#include "face_fit/find/network/face_finder.h"
#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "fsm/head/warp.h"
#include "fsm/mesh/original/original_points.h"

namespace facefit {
namespace {

constexpr NamedPoint kNames[] = {{"right_eye_outer", point::kEyeOuterRight, true},
                                 {"left_eye_outer", point::kEyeOuterLeft, true},
                                 {"nose_tip", point::kNoseTip, true},
                                 {"mouth_right", point::kMouthRight, true},
                                 {"mouth_left", point::kMouthLeft, true},
                                 {"chin", point::kChin, true},
                                 {"right_eye_inner", point::kEyeInnerRight, false},
                                 {"left_eye_inner", point::kEyeInnerLeft, false},
                                 {"right_eye_top", point::kEyeTopRight, false},
                                 {"left_eye_top", point::kEyeTopLeft, false},
                                 {"right_eye_bottom", point::kEyeBottomRight, false},
                                 {"left_eye_bottom", point::kEyeBottomLeft, false},
                                 {"right_brow", point::kBrowRight, false},
                                 {"left_brow", point::kBrowLeft, false},
                                 {"nose_bottom", point::kNoseBottom, false},
                                 {"nose_right", point::kNoseRight, false},
                                 {"nose_left", point::kNoseLeft, false},
                                 {"lip_top", point::kLipTop, false},
                                 {"lip_bottom", point::kLipBottom, false},
                                 {"jaw_right", point::kJawRight, false},
                                 {"jaw_left", point::kJawLeft, false},
                                 {"cheek_right", point::kCheekRight, false},
                                 {"cheek_left", point::kCheekLeft, false},
                                 {"forehead", point::kForehead, false}};

/// Maps the front of the base head (millimetres, y up) to pixels by a similarity found by least
/// squares (Umeyama 1991).
class ToPhoto {
 public:
  ToPhoto(const ObservedHead& base, const HandPoints& points) {
    const auto count = static_cast<Eigen::Index>(points.size());
    Eigen::MatrixXd from(2, count), to(2, count);
    Eigen::Index column = 0;
    for (const auto& [i, at] : points) {
      const glm::vec3 p = base.AtRest(i);
      from.col(column) << p.x, -p.y;
      to.col(column++) << at.x, at.y;
    }
    map_ = Eigen::umeyama(from, to);
  }
  glm::vec2 operator()(glm::vec2 mm) const {
    const Eigen::Vector3d p = map_ * Eigen::Vector3d(mm.x, -mm.y, 1);
    return {static_cast<float>(p.x()), static_cast<float>(p.y())};
  }
  float pixels_per_mm() const {
    const auto cosine = static_cast<float>(map_(0, 0)), sine = static_cast<float>(map_(1, 0));
    return std::max(std::hypot(cosine, sine), 1e-6F);  // both times the scale
  }

 private:
  Eigen::Matrix3d map_;
};

PointIndex PointAt(const fsm::TableRow& row) {
  const std::string& key = row.key();
  const auto named = std::ranges::find(kNames, key, &NamedPoint::name);
  if (named != std::end(kNames)) return named->point;
  const auto number = fsm::ParseNumber<unsigned>(key);
  if (!number || *number >= kNetworkPoints) {
    row.Refuse("'" + key.substr(0, 30) + "' is no point; 0 to 467 or one of " + PointNamesText() +
               " expected");
  }
  return *number;
}

/// REQUIRES: the points that are needed.
std::optional<std::string> CoincidingCornersOf(const HandPoints& points) {
  return CoincidingCorners([&](PointIndex i) { return points.at(i); });
}

}  // namespace

std::span<const NamedPoint> NamedPoints() { return kNames; }

std::string PointNamesText() {
  std::string names;
  for (const NamedPoint& named : kNames)
    names += (names.empty() ? "" : " ") + std::string(named.name);
  return names;
}

vm::Result<HandPoints> ParseHandPoints(const std::string& name, std::string_view text) {
  return fsm::ReadTable(name, text, [](const fsm::Table& table) {
    constexpr float kFarthest = 1e5F;
    HandPoints points;
    for (const fsm::TableRow& row : table.rows()) {
      if (row.size() != 3) row.Refuse("NAME X Y expected, as: chin 320 455");
      const glm::vec2 at(row.Within(1, -kFarthest, kFarthest),
                         row.Within(2, -kFarthest, kFarthest));
      if (!points.emplace(PointAt(row), at).second) {
        row.Refuse("'" + row.key() + "' is set a second time");
      }
    }
    for (const NamedPoint& named : kNames) {
      if (named.needed && !points.contains(named.point)) {
        table.Refuse(std::string(named.name) + " is missing");
      }
    }
    if (const auto why = CoincidingCornersOf(points)) table.Refuse(*why);
    return points;
  });
}

vm::Result<void> CheckWithin(const HandPoints& points, int width, int height) {
  const glm::vec2 size(width, height);
  const bool some = std::ranges::any_of(points, [&](const auto& point) {
    const glm::vec2 at = point.second;
    return at.x >= 0 && at.y >= 0 && at.x <= size.x && at.y <= size.y;
  });
  if (some) return {};
  return vm::Fail(vm::Errc::kBadValue, "none of the points lies in the photo, which is " +
                                           std::to_string(width) + " x " + std::to_string(height) +
                                           " pixels where points are set");
}

vm::Result<HandPoints> PointsOfWireframe(const std::string& name, const fsm::PntFile& wireframe,
                                         int width, int height) {
  // For the points of the original's standard head see fsm/mesh/original/original_points.h.
  constexpr std::pair<PointIndex, fsm::PointName> kSame[] = {
      {point::kEyeOuterRight, {4, 23}}, {point::kEyeInnerRight, {4, 17}},
      {point::kEyeTopRight, {4, 20}},   {point::kEyeBottomRight, {4, 26}},
      {point::kEyeOuterLeft, {5, 23}},  {point::kEyeInnerLeft, {5, 17}},
      {point::kEyeTopLeft, {5, 20}},    {point::kEyeBottomLeft, {5, 26}},
      {point::kNoseTip, {3, 15}},       {point::kNoseBottom, {3, 25}},
      {point::kNoseRight, {3, 18}},     {point::kNoseLeft, {3, 22}},
      {point::kMouthRight, {1, 33}},    {point::kMouthLeft, {2, 33}},
      {point::kChin, fsm::kChin}};
  if (auto whole = fsm::CheckPoints(name, wireframe); !whole) return std::unexpected(whole.error());
  HandPoints points;
  for (const auto& [point, of] : kSame) {
    const glm::vec3 p = wireframe.positions[wireframe.index.at(of)];
    points[point] = {0.5F * (p.x + 1) * static_cast<float>(width),
                     0.5F * (1 - p.y) * static_cast<float>(height)};
  }
  if (const auto why = CoincidingCornersOf(points)) {
    return vm::Fail(vm::Errc::kBadValue, name + ": " + *why);
  }
  return points;
}

FoundFace FaceFromHand(const ObservedHead& base, const HandPoints& points) {
  assert(std::ranges::all_of(NamedPoints(), [&](const NamedPoint& named) {
    return !named.needed || points.contains(named.point);
  }));
  const ToPhoto to_photo(base, points);
  std::vector<fsm::WarpPoint> bends;
  for (const auto& [i, at] : points) {
    bends.push_back(
        {base.AtRest(i),
         glm::vec3((at - to_photo(glm::vec2(base.AtRest(i)))) / to_photo.pixels_per_mm(), 0)});
  }
  const fsm::Warp warp(bends, 0.5F);
  FoundFace face;
  face.certainty = 1;
  for (std::size_t i = 0; i < kNetworkPoints; ++i) {
    const glm::vec3 p = base.AtRest(i);
    const glm::vec2 pixel =
        to_photo(glm::vec2(p)) + to_photo.pixels_per_mm() * glm::vec2(warp.Motion(p));
    face.points[i] = glm::vec3(pixel, to_photo.pixels_per_mm() * base.DetectedDepthMm(i));
  }
  face.crop = CropAround(face.points);
  return face;
}

}  // namespace facefit
