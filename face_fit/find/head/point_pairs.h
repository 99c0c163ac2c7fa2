#pragma once

#include <span>
#include <vector>

#include "fsm/mesh/head_points.h"

namespace facefit {

/// Returns the pairs without outliers. At the outline of a face a point may miss the cheek and lie
/// on an ear or the neck, centimetres behind; a few such pairs would turn the whole head when it is
/// aligned with the base head. REQUIRES: as FitSimilarity.
std::vector<fsm::PointPair> RejectOutliers(std::span<const fsm::PointPair> pairs);

/// Returns the pairs with positions averaged with their mirrored counterparts where the two nearly
/// agree: heads are symmetric, so the mean is more accurate. `to_base` transforms the pairs' `to`
/// into our frame, facing about +z.
std::vector<fsm::PointPair> Symmetrise(const fsm::Similarity& to_base,
                                       std::vector<fsm::PointPair> pairs);

}  // namespace facefit
