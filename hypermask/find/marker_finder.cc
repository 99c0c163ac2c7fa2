#include "hypermask/find/marker_finder.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace hypermask {
namespace {

/// How much the mask may be foreshortened: cos 60 degrees.
constexpr double kLeastForeshortening = 0.5;
/// The smallest mask that is taken for one: a tenth of a typical picture's height.
constexpr double kLeastHeight = 20;
/// How far a marker may lie from where the corners have it, in parts of the mask's height.
constexpr double kMarkerTolerance = 0.06;

/// The area of a triangle, twice; positive if a, b, c go clockwise (y points down).
double Turn(const Point& a, const Point& b, const Point& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// The four spots in clockwise order; false if they are not convex.
bool SortClockwise(const std::vector<Spot>& spots, std::array<std::size_t, 4>& four) {
  Point middle(0, 0);
  for (const std::size_t i : four) middle += spots[i].place / 4;
  std::ranges::sort(four, {}, [&](std::size_t i) {
    const Point at = spots[i].place - middle;
    return std::atan2(at.y(), at.x());
  });
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(Turn(spots[four[i]].place, spots[four[(i + 1) % 4]].place,
               spots[four[(i + 2) % 4]].place) > 1)) {
      return false;
    }
  }
  return true;
}

}  // namespace

/// A way to see the mask in a picture, and how good it is.
struct MarkerFinder::View {
  FoundMarkers markers{};
  double upright = -2;  // cosine of the turn in the picture
  double miss = 0;      // pixels, of the markers beside the corners
  bool BetterThan(const View& other) const {
    if (markers.seen != other.markers.seen) return markers.seen > other.markers.seen;
    // Four markers alone cannot tell; else the way that fits best.
    if (markers.seen == 4) return upright > other.upright;
    return miss < other.miss;
  }
};

bool MarkerFinder::LooksLikeMask(const PlaneMap& map) const {
  // All of the mask must lie before the camera.
  for (const Point& marker : layout_.markers) {
    if (!((map * marker.homogeneous()).z() * map(2, 2) > 0)) return false;
  }
  // How the mask's middle is stretched.
  const Point middle = Apply(map, Point(0, 0));
  Eigen::Matrix2d stretch;
  stretch << Apply(map, Point(1, 0)) - middle, Apply(map, Point(0, 1)) - middle;
  if (!(stretch.determinant() > 0)) return false;
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(stretch);
  if (svd.singularValues()[1] < kLeastForeshortening * svd.singularValues()[0]) return false;
  return svd.singularValues()[0] * 2 * layout_.oval.y() >= kLeastHeight;
}

void MarkerFinder::TryCorners(const std::vector<Spot>& spots,
                              const std::array<std::size_t, 4>& corners, View& best) const {
  const Points model(layout_.markers.begin(), layout_.markers.begin() + 4);
  for (std::size_t first = 0; first < 4; ++first) {
    View view;
    for (std::size_t i = 0; i < 4; ++i) {
      view.markers.places.push_back(spots[corners[(first + i) % 4]].place);
    }
    const auto map = FitHomography(model, view.markers.places);
    if (!map || !LooksLikeMask(*map)) continue;
    view.markers.seen = 4;
    const Point down = Apply(*map, Point(0, 1)) - Apply(*map, Point(0, -1));
    view.upright = down.normalized().y();
    const double height = (view.markers.places[3] - view.markers.places[0]).norm();
    for (std::size_t i = 4; i < layout_.markers.size(); ++i) {
      const Point expected = Apply(*map, layout_.markers[i]);
      double nearest = kMarkerTolerance * height;
      Point place = expected;
      bool seen = false;
      for (const Spot& spot : spots) {
        if (const double distance = (spot.place - expected).norm(); distance < nearest) {
          nearest = distance;
          place = spot.place;
          seen = true;
        }
      }
      view.markers.places.push_back(place);
      view.markers.seen += seen ? 1 : 0;
      if (seen) view.miss += nearest;
    }
    if (view.BetterThan(best)) best = std::move(view);
  }
}

std::optional<FoundMarkers> MarkerFinder::Search(const std::vector<Spot>& spots) const {
  View best;
  const std::size_t n = spots.size();
  for (std::size_t a = 0; a + 3 < n; ++a) {
    for (std::size_t b = a + 1; b + 2 < n; ++b) {
      for (std::size_t c = b + 1; c + 1 < n; ++c) {
        for (std::size_t d = c + 1; d < n; ++d) {
          std::array<std::size_t, 4> corners{a, b, c, d};
          if (SortClockwise(spots, corners)) TryCorners(spots, corners, best);
        }
      }
    }
  }
  // Where others could tell the corners apart, one of them must.
  const std::size_t least = layout_.markers.size() > 4 ? 5 : 4;
  if (best.markers.seen < least) return std::nullopt;
  return std::move(best.markers);
}

std::optional<FoundMarkers> MarkerFinder::Follow(const std::vector<Spot>& spots,
                                                 const Points& expected, double radius) const {
  assert(expected.size() == layout_.markers.size());
  struct Pair {
    double distance;
    std::size_t marker, spot;
  };
  std::vector<Pair> pairs;
  for (std::size_t m = 0; m < expected.size(); ++m) {
    for (std::size_t s = 0; s < spots.size(); ++s) {
      const double distance = (spots[s].place - expected[m]).norm();
      if (distance <= radius) pairs.push_back({distance, m, s});
    }
  }
  std::ranges::sort(pairs, {}, &Pair::distance);
  std::vector<std::optional<Point>> seen(expected.size());
  std::vector<bool> taken(spots.size(), false);
  Points model, places;
  for (const Pair& pair : pairs) {
    if (seen[pair.marker] || taken[pair.spot]) continue;
    seen[pair.marker] = spots[pair.spot].place;
    taken[pair.spot] = true;
    model.push_back(layout_.markers[pair.marker]);
    places.push_back(spots[pair.spot].place);
  }
  if (places.size() < 3) return std::nullopt;
  const auto map = places.size() == 3 ? FitAffine(model, places) : FitHomography(model, places);
  if (!map || !LooksLikeMask(*map)) return std::nullopt;
  // A spot taken for a marker that it is not bends the view.
  const double height = (Apply(*map, layout_.markers[3]) - Apply(*map, layout_.markers[0])).norm();
  if (RmsDistance(*map, model, places) > 0.5 * kMarkerTolerance * height) return std::nullopt;
  FoundMarkers found{.seen = places.size()};
  for (std::size_t m = 0; m < expected.size(); ++m) {
    found.places.push_back(seen[m] ? *seen[m] : Apply(*map, layout_.markers[m]));
  }
  return found;
}

}  // namespace hypermask
