#include "hypermask/sim/stage.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace hypermask {
namespace {

constexpr double kPixelsPerMm = 2;  // of the plate's picture
constexpr std::size_t kNoises = 1u << 16;

cv::Matx33d Matrix(const PlaneMap& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

struct Box {
  Point low, high;
};

/// The plate reaches a little beyond its markers.
Box PlateBox(const MaskLayout& layout) {
  constexpr double kRim = 16;
  Box box{-layout.oval, layout.oval};
  for (const Point& marker : layout.markers) {
    box.low = box.low.cwiseMin(marker);
    box.high = box.high.cwiseMax(marker);
  }
  box.low.array() -= kRim;
  box.high.array() += kRim;
  return box;
}

/// What is projected, without the light that the mask keeps from the curtain.
cv::Mat PastTheMask(const Stage& stage, const Pose& mask, const cv::Mat& shown) {
  cv::Mat past = shown.clone();
  std::vector<cv::Point> outline;
  for (const Point& p : Apply(stage.projector.Of(mask), PlateOutline(stage.layout))) {
    outline.emplace_back(static_cast<int>(std::lround(p.x())),
                         static_cast<int>(std::lround(p.y())));
  }
  cv::fillPoly(past, std::vector<std::vector<cv::Point>>{outline}, cv::Scalar(0, 0, 0, 255));
  return past;
}

Pose Curtain(const Stage& stage) {
  return {Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, stage.curtain_z)};
}

}  // namespace

Viewpoint Viewpoint::LookingAt(const Pinhole& lens, const Eigen::Vector3d& from,
                               const Eigen::Vector3d& to) {
  const Eigen::Vector3d z = (to - from).normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Viewpoint view{.lens = lens};
  view.world.rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
  view.world.position = -view.world.rotation * from;
  return view;
}

PlaneMap Viewpoint::Of(const Pose& plane) const {
  return PlaneToPicture(
      lens, {world.rotation * plane.rotation, world.rotation * plane.position + world.position});
}

Stage::Stage()
    : projector(Viewpoint::LookingAt(Pinhole::OfField(1280, 720, 26), {0, 0, 0}, {15, -10, 2000})),
      camera(Viewpoint::LookingAt(Pinhole::OfField(640, 480, 33), {150, -70, 40}, {0, 0, 2000})),
      audience(
          Viewpoint::LookingAt(Pinhole::OfField(1280, 720, 24), {-420, -120, 100}, {0, 25, 2000})) {
  // No lens is quite what its maker says.
  projector.lens.centre_y += 25;
  camera.lens.centre_x += 3;
  camera.lens.centre_y -= 2;
}

Points PlateOutline(const MaskLayout& layout) {
  const Box box = PlateBox(layout);
  const Point middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
  constexpr int kSides = 96;
  constexpr double kPower = 2.0 / 3.2;  // of a superellipse
  Points outline;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    const auto reach = [](double v) { return std::copysign(std::pow(std::abs(v), kPower), v); };
    outline.push_back(middle +
                      Point(half.x() * reach(std::cos(angle)), half.y() * reach(std::sin(angle))));
  }
  return outline;
}

StageCamera::StageCamera(const Stage& stage) : stage_(stage), noise_(kNoises) {
  std::uint32_t random = 12345;
  const auto next = [&] {
    random = 1664525u * random + 1013904223u;
    return (static_cast<double>(random >> 8) + 0.5) / (1 << 24);
  };
  for (float& value : noise_) {  // Box and Muller 1958
    const double radius = std::sqrt(-2 * std::log(next()));
    value = static_cast<float>(stage.noise * radius * std::cos(2 * std::numbers::pi * next()));
  }
}

void StageCamera::AddMarkers(const Pose& mask, double part, unsigned hidden,
                             std::vector<float>& light) const {
  constexpr double kGlow = 330;    // brightness in the middle; the camera saturates at 255
  constexpr double kSpread = 1.5;  // pixels
  const Pinhole& lens = stage_.camera.lens;
  const Points places = Apply(stage_.camera.Of(mask), stage_.layout.markers);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if ((hidden >> i & 1) != 0) continue;
    const int reach = 7;
    const int x0 = static_cast<int>(std::lround(places[i].x()));
    const int y0 = static_cast<int>(std::lround(places[i].y()));
    for (int y = std::max(0, y0 - reach); y <= std::min(lens.height - 1, y0 + reach); ++y) {
      for (int x = std::max(0, x0 - reach); x <= std::min(lens.width - 1, x0 + reach); ++x) {
        const double square = (Point(x, y) - places[i]).squaredNorm();
        light[static_cast<std::size_t>(y) * static_cast<std::size_t>(lens.width) +
              static_cast<std::size_t>(x)] +=
            static_cast<float>(part * kGlow * std::exp(-square / (2 * kSpread * kSpread)));
      }
    }
  }
}

void StageCamera::AddProjected(const Pose& mask, const fsm::Image& shown,
                               std::vector<float>& light) const {
  constexpr double kOnMask = 0.62, kOnCurtain = 0.12;  // of full brightness that the camera sees
  const Pinhole& lens = stage_.camera.lens;
  Grey grey;
  ToGrey(shown, grey);
  const cv::Mat source(shown.height, shown.width, CV_8UC1, grey.pixels.data());
  const auto seen_on = [&](const Pose& plane, const cv::Mat& projected) {
    cv::Mat out;
    const PlaneMap map = stage_.camera.Of(plane) * stage_.projector.Of(plane).inverse();
    cv::warpPerspective(projected, out, Matrix(map), {lens.width, lens.height});
    return out;
  };
  const cv::Mat curtain = seen_on(Curtain(stage_), PastTheMask(stage_, mask, source));
  const cv::Mat on_mask = seen_on(mask, source);
  cv::Mat plate(lens.height, lens.width, CV_8UC1, cv::Scalar(0));
  std::vector<cv::Point> outline;
  for (const Point& p : Apply(stage_.camera.Of(mask), PlateOutline(stage_.layout))) {
    outline.emplace_back(static_cast<int>(std::lround(p.x())),
                         static_cast<int>(std::lround(p.y())));
  }
  cv::fillPoly(plate, std::vector<std::vector<cv::Point>>{outline}, cv::Scalar(255));
  for (std::size_t i = 0; i < light.size(); ++i) {
    light[i] += static_cast<float>(plate.data[i] != 0 ? kOnMask * on_mask.data[i]
                                                      : kOnCurtain * curtain.data[i]);
  }
}

void StageCamera::See(const Pose& mask, const Pose& mask_later, std::uint32_t number,
                      unsigned hidden, const fsm::Image* shown, Grey& out) const {
  const Pinhole& lens = stage_.camera.lens;
  if (out.width != lens.width || out.height != lens.height) out = Grey(lens.width, lens.height);
  constexpr float kAmbient = 14;
  std::vector<float> light(out.pixels.size(), kAmbient);
  // Open from the first to the second pose.
  constexpr int kParts = 4;
  for (int i = 0; i < kParts; ++i) {
    const double part = (i + 0.5) / kParts;
    const Pose between{Eigen::Quaterniond(mask.rotation)
                           .slerp(part, Eigen::Quaterniond(mask_later.rotation))
                           .toRotationMatrix(),
                       mask.position + part * (mask_later.position - mask.position)};
    AddMarkers(between, 1.0 / kParts, hidden, light);
  }
  if (shown) AddProjected(mask, *shown, light);
  const std::size_t from = number * 40503u;
  for (std::size_t i = 0; i < light.size(); ++i) {
    // Rows begin elsewhere in the noise each, so that it has no pattern.
    const std::size_t at = from + i + 7919u * (i / static_cast<std::size_t>(lens.width));
    const float value = light[i] + noise_[at % kNoises];
    out.pixels[i] = static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
  }
}

StageView::StageView(const Stage& stage) : stage_(stage) {
  const Box box = PlateBox(stage.layout);
  const Point size = kPixelsPerMm * (box.high - box.low);
  plate_ = fsm::FilledImage(static_cast<int>(size.x()), static_cast<int>(size.y()), {0, 0, 0, 0});
  cv::Mat picture(plate_.height, plate_.width, CV_8UC4, plate_.rgba.data());
  std::vector<cv::Point> outline;
  for (const Point& p : PlateOutline(stage.layout)) {
    const Point at = kPixelsPerMm * (p - box.low);
    outline.emplace_back(static_cast<int>(at.x()), static_cast<int>(at.y()));
  }
  cv::fillPoly(picture, std::vector<std::vector<cv::Point>>{outline},
               cv::Scalar(255, 255, 255, 255), cv::LINE_AA);
  // Darker towards its rim, as a plate that bends away there.
  for (int y = 0; y < plate_.height; ++y) {
    for (int x = 0; x < plate_.width; ++x) {
      const Point mm = Point(x, y) / kPixelsPerMm + box.low;
      const double radius = mm.cwiseQuotient(0.5 * (box.high - box.low)).norm();
      const double shade = 1 - 0.45 * std::pow(std::min(1.3, radius), 3);
      for (std::size_t c = 0; c < 3; ++c) {
        std::uint8_t& value = plate_.rgba[4 * plate_.Index(x, y) + c];
        value = static_cast<std::uint8_t>(shade * value);
      }
    }
  }
}

void StageView::See(const Pose& mask, const fsm::Image& shown, fsm::Image& out) const {
  const Viewpoint& eye = stage_.audience;
  const cv::Size size(eye.lens.width, eye.lens.height);
  out = fsm::FilledImage(size.width, size.height, fsm::kBlack);
  const cv::Mat source(shown.height, shown.width, CV_8UC4,
                       const_cast<std::uint8_t*>(shown.rgba.data()));
  const auto seen_on = [&](const Pose& plane, const cv::Mat& projected) {
    cv::Mat seen;
    const PlaneMap map = eye.Of(plane) * stage_.projector.Of(plane).inverse();
    cv::warpPerspective(projected, seen, Matrix(map), size, cv::INTER_LINEAR, cv::BORDER_CONSTANT,
                        cv::Scalar(0, 0, 0, 255));
    return seen;
  };
  const cv::Mat curtain = seen_on(Curtain(stage_), PastTheMask(stage_, mask, source));
  const cv::Mat on_mask = seen_on(mask, source);
  const Box box = PlateBox(stage_.layout);
  PlaneMap to_mm;
  to_mm << 1 / kPixelsPerMm, 0, box.low.x(), 0, 1 / kPixelsPerMm, box.low.y(), 0, 0, 1;
  const cv::Mat plate_picture(plate_.height, plate_.width, CV_8UC4,
                              const_cast<std::uint8_t*>(plate_.rgba.data()));
  cv::Mat plate;
  cv::warpPerspective(plate_picture, plate, Matrix(eye.Of(mask) * to_mm), size, cv::INTER_AREA,
                      cv::BORDER_CONSTANT, cv::Scalar(0, 0, 0, 0));
  // Who wears it: a dark figure behind the mask.
  cv::Mat figure(size, CV_8UC1, cv::Scalar(0));
  const auto place = [&](double x, double y, double z) {
    const Eigen::Vector3d at =
        eye.world.rotation * (mask.position + Eigen::Vector3d(x, y, z)) + eye.world.position;
    return Point(eye.lens.focal * at.x() / at.z() + eye.lens.centre_x,
                 eye.lens.focal * at.y() / at.z() + eye.lens.centre_y);
  };
  const Point shoulders = place(0, 560, 110), head = place(0, -20, 130);
  const double scale = (place(100, 0, 110) - place(0, 0, 110)).norm() / 100;
  const auto ellipse = [&](const Point& at, double width, double height) {
    cv::ellipse(figure, cv::Point(static_cast<int>(at.x()), static_cast<int>(at.y())),
                cv::Size(static_cast<int>(scale * width), static_cast<int>(scale * height)), 0, 0,
                360, cv::Scalar(255), cv::FILLED, cv::LINE_AA);
  };
  ellipse(shoulders, 270, 330);
  ellipse(head, 135, 200);
  ellipse(place(0, 200, 110), 75, 120);

  constexpr double kAmbient = 0.30, kOnMask = 0.85, kCurtainLight = 0.55;
  constexpr std::array<double, 3> kCurtain{0.62, 0.26, 0.24}, kFigure{0.30, 0.31, 0.40};
  std::vector<double> folds;  // of the curtain, which stand fast
  for (int x = 0; x < size.width; ++x) {
    folds.push_back(0.75 + 0.25 * std::sin(0.055 * x + 0.6 * std::sin(0.011 * x)));
  }
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const std::size_t at = 4 * out.Index(x, y);
      const double fold = folds[static_cast<std::size_t>(x)];
      const double worn = figure.data[at / 4] / 255.0, alpha = plate.data[at + 3] / 255.0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double ground = kCurtain[c] * fold;
        const double lit = curtain.data[at + c] / 255.0;
        double value = ground * (kAmbient + kCurtainLight * lit);
        value += worn * (kFigure[c] * (kAmbient + 0.9 * lit) - value);
        // The plate's colour is already multiplied by its opacity.
        const double own = plate.data[at + c] / 255.0;
        value = (1 - alpha) * value + own * (kAmbient + kOnMask * on_mask.data[at + c] / 255.0);
        out.rgba[at + c] = static_cast<std::uint8_t>(255 * std::clamp(value, 0.0, 1.0));
      }
    }
  }
  cv::Mat picture(size, CV_8UC4, out.rgba.data());
  for (const Point& marker : Apply(eye.Of(mask), stage_.layout.markers)) {
    cv::circle(picture, cv::Point(static_cast<int>(marker.x()), static_cast<int>(marker.y())), 3,
               cv::Scalar(120, 30, 40, 255), cv::FILLED, cv::LINE_AA);
  }
}

std::vector<double> LandingDistances(const Stage& stage, const PlaneMap& map, const Pose& truth) {
  const PlaneMap right = stage.projector.Of(truth);
  const Point& oval = stage.layout.oval;
  std::vector<double> distances;
  for (const Point& point : {Point(0, 0), Point(oval.x(), 0), Point(-oval.x(), 0),
                             Point(0, oval.y()), Point(0, -oval.y())}) {
    distances.push_back((Apply(map, point) - Apply(right, point)).norm());
  }
  return distances;
}

}  // namespace hypermask
