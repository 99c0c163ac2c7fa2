#pragma once

#include <vector>

#include "fsm/mesh/head_points.h"

namespace facefit {

/// At the outline of a face a point may miss the cheek and come to lie on an ear or the neck,
/// centimetres behind: a few such pairs turn the whole head when it is fitted to ours. Leaves out
/// those that lie much farther off than most. REQUIRES: as FitSimilarity.
void LeaveOutStrays(std::vector<fsm::PlacePair>& pairs);

/// Heads are made symmetric, and so is ours: where a place and its opposite nearly mirror each
/// other their mean is nearer to the truth than what the network saw of each. `place` brings the
/// pairs' `to` into our frame, looking roughly to +z.
void Balance(const fsm::Similarity& place, std::vector<fsm::PlacePair>& pairs);

}  // namespace facefit
