#include "hypermask/calibrate/calibrator.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace hypermask {
namespace {

/// Dots nearer to the oval's edge than this part of its radius may lie half beside the mask.
constexpr double kInside = 0.93;
constexpr std::size_t kLeastDots = 8;
/// A dot is taken for lit from this part of its brightness on.
constexpr double kLit = 0.5;
/// How far the mask may move while it is looked at, pixels.
constexpr double kStill = 0.7;

Grey Difference(const Grey& light, const Grey& dark) {
  Grey out(light.width, light.height);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    out.pixels[i] = static_cast<std::uint8_t>(std::max(0, light.pixels[i] - dark.pixels[i]));
  }
  return out;
}

/// Mean brightness about a place.
double BrightnessAt(const Grey& picture, const Point& place) {
  const int x0 = static_cast<int>(std::lround(place.x())),
            y0 = static_cast<int>(std::lround(place.y()));
  int sum = 0, count = 0;
  for (int y = std::max(0, y0 - 1); y <= std::min(picture.height - 1, y0 + 1); ++y) {
    for (int x = std::max(0, x0 - 1); x <= std::min(picture.width - 1, x0 + 1); ++x) {
      sum += picture.pixels[picture.Index(x, y)];
      ++count;
    }
  }
  return count > 0 ? static_cast<double>(sum) / count : 0;
}

}  // namespace

vm::Result<Place> ReadPlace(const DotPattern& pattern, const std::vector<Grey>& pictures,
                            const MarkerFinder& finder) {
  if (pictures.size() != pattern.frames()) {
    return vm::Fail(vm::Errc::kUnavailable, fmt::format("{} of the pattern's {} frames were seen",
                                                        pictures.size(), pattern.frames()));
  }
  const Grey& dark = pictures.front();
  const auto markers = finder.Search(FindSpots(dark, {}));
  const auto later = finder.Search(FindSpots(pictures.back(), {}));
  if (!markers || !later) {
    return vm::Fail(vm::Errc::kUnavailable,
                    fmt::format("the mask's {} markers are not seen while the projector is dark "
                                "({} bright spots)",
                                finder.layout().markers.size(), FindSpots(dark, {}).size()));
  }
  for (std::size_t i = 0; i < markers->places.size(); ++i) {
    if ((markers->places[i] - later->places[i]).norm() > kStill) {
      return vm::Fail(vm::Errc::kUnavailable,
                      fmt::format("the mask moved by {:.1f} pixels of the camera meanwhile, "
                                  "expected at most {:g}",
                                  (markers->places[i] - later->places[i]).norm(), kStill));
    }
  }
  const auto to_mask = FitHomography(markers->places, finder.layout().markers);
  if (!to_mask) return vm::Fail(vm::Errc::kUnavailable, "the markers lie in one line");
  Place place{.markers = markers->places};
  const Grey all = Difference(pictures[1], dark);
  std::vector<Grey> frames;
  for (std::size_t f = 2; f + 1 < pictures.size(); ++f) {
    frames.push_back(Difference(pictures[f], dark));
  }
  constexpr std::size_t kMostDots = 4000;
  for (const Spot& spot :
       FindSpots(all, {.threshold = 0.35, .least_contrast = 20, .most = kMostDots})) {
    const Point on_mask = Apply(*to_mask, spot.place);
    if (on_mask.cwiseQuotient(finder.layout().oval).norm() > kInside) continue;
    const double full = BrightnessAt(all, spot.place);
    std::vector<bool> lit;
    for (const Grey& frame : frames) lit.push_back(BrightnessAt(frame, spot.place) > kLit * full);
    const auto projected = pattern.Decode(lit);
    if (!projected) continue;
    place.seen.push_back(spot.place);
    place.projected.push_back(*projected);
  }
  if (place.seen.size() < kLeastDots) {
    return vm::Fail(vm::Errc::kUnavailable,
                    fmt::format("the camera sees {} projected dots on the mask, expected at least "
                                "{} (is the infrared filter off, is the mask in the projector's "
                                "light?)",
                                place.seen.size(), kLeastDots));
  }
  return place;
}

std::optional<fsm::Image> PlaceTaker::Begin(double ms) {
  if (pictures_.size() == pattern_.frames()) return std::nullopt;
  shown_ms_ = ms;
  taken_ = 0;
  return pattern_.Frame(pictures_.size());
}

bool PlaceTaker::Take(const Grey& picture, double ms) {
  if (ms < shown_ms_ + settle_ms_ || pictures_.size() == pattern_.frames()) return false;
  if (taken_ == 0 || sum_.size() != picture.pixels.size()) {
    sum_.assign(picture.pixels.size(), 0);
    taken_ = 0;
  }
  for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += picture.pixels[i];
  if (++taken_ < kPictures) return false;
  Grey mean(picture.width, picture.height);
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    mean.pixels[i] = static_cast<std::uint8_t>((sum_[i] + kPictures / 2) / kPictures);
  }
  pictures_.push_back(std::move(mean));
  return true;
}

vm::Result<Calibration> Calibrate(const std::vector<Place>& places, const MaskLayout& layout,
                                  const Pinhole& camera, int projector_width,
                                  int projector_height) {
  if (places.size() < kLeastPlaces) {
    return vm::Fail(vm::Errc::kUnavailable,
                    fmt::format("the mask was held still in {} places, expected at least {}",
                                places.size(), kLeastPlaces));
  }
  Calibration found{
      .camera = camera, .projector_width = projector_width, .projector_height = projector_height};
  Points seen, projected;
  std::vector<Eigen::Vector3d> in_space;
  for (const Place& place : places) {
    const auto view = FitHomography(layout.markers, place.markers);
    const auto pose = view ? PoseOfPlane(camera, *view) : std::nullopt;
    if (!pose) return vm::Fail(vm::Errc::kUnavailable, "a place's markers are no view of the mask");
    const PlaneMap to_mask = view->inverse();
    for (std::size_t i = 0; i < place.seen.size(); ++i) {
      const Point on_mask = Apply(to_mask, place.seen[i]);
      in_space.push_back(pose->rotation * Eigen::Vector3d(on_mask.x(), on_mask.y(), 0) +
                         pose->position);
      seen.push_back(place.seen[i]);
      projected.push_back(place.projected[i]);
    }
  }
  const auto homography = FitHomography(seen, projected);
  const auto affine = FitAffine(seen, projected);
  const auto space = FitSpaceMap(in_space, projected);
  if (!homography || !affine || !space) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "the places lie in one plane: hold the mask nearer and farther, and turned");
  }
  found.homography = *homography;
  found.affine = *affine;
  found.space = *space;
  found.homography_rms = RmsDistance(*homography, seen, projected);
  found.affine_rms = RmsDistance(*affine, seen, projected);
  double sum = 0;
  for (std::size_t i = 0; i < in_space.size(); ++i) {
    sum += (Apply(*space, in_space[i]) - projected[i]).squaredNorm();
  }
  found.space_rms = std::sqrt(sum / static_cast<double>(in_space.size()));
  return found;
}

}  // namespace hypermask
