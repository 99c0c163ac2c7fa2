#pragma once

#include <span>
#include <vector>

#include "fsm/mesh/head_points.h"

namespace facefit {

/// The pairs without those that lie much farther off than most. At the outline of a face a point
/// may miss the cheek and lie on an ear or the neck, centimetres behind; a few such pairs would
/// turn the whole head when it is fitted to ours. REQUIRES: as FitSimilarity.
std::vector<fsm::PointPair> RejectOutliers(std::span<const fsm::PointPair> pairs);

/// The pairs with places averaged with their mirrored opposites where both nearly agree: heads are
/// symmetric, so the mean is nearer to the truth than what the network saw of each. `to_ours`
/// brings the pairs' `to` into our frame, looking roughly to +z.
std::vector<fsm::PointPair> Symmetrise(const fsm::Similarity& to_ours,
                                       std::vector<fsm::PointPair> pairs);

}  // namespace facefit
