#pragma once

#include <array>
#include <optional>
#include <vector>

#include "hypermask/base/mask_layout.h"
#include "hypermask/find/spots.h"

namespace hypermask {

/// Where the markers are in a picture.
struct FoundMarkers {
  Points places{};       ///< of all, by their number in the layout
  std::size_t seen = 0;  ///< how many were seen; the others lie where these say
};

/// Tells which bright spot is which marker. Pure: remembers nothing. Thread: any.
class MarkerFinder {
 public:
  explicit MarkerFinder(MaskLayout layout) : layout_(std::move(layout)) {}

  /// Without knowing where the mask was: four spots that form a view of the corners, turned by up
  /// to 60 degrees away from the camera and any way round, and those of the other markers where
  /// they then must be. Of a layout of four markers, which looks alike from all sides, the view
  /// that stands the most upright. At least four markers must be seen, all corners among them.
  std::optional<FoundMarkers> Search(const std::vector<Spot>& spots) const;
  /// Near where they should be, within `radius` pixels: three are enough, the others are placed by
  /// a homography of those that are seen, or by an affine map of three.
  std::optional<FoundMarkers> Follow(const std::vector<Spot>& spots, const Points& expected,
                                     double radius) const;

  const MaskLayout& layout() const { return layout_; }

 private:
  struct View;
  bool LooksLikeMask(const PlaneMap& map) const;
  void TryCorners(const std::vector<Spot>& spots, const std::array<std::size_t, 4>& corners,
                  View& best) const;
  const MaskLayout layout_;
};

}  // namespace hypermask
