#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "face_track/model/seen_face.h"

namespace facetrack {

/// What a picture tells of small steps from a state, summed over its points, each in parts of how
/// surely it is seen: products of what a step of place and doses moves (columns: six of the pose,
/// then channels), of what variations move, and of what is missed.
struct Evidence {
  static constexpr int kPose = 6;  ///< steps of the turn and the place
  Eigen::MatrixXf steps;           ///< steps with steps
  Eigen::MatrixXf shared;          ///< variations (rows) with steps
  Eigen::MatrixXf variations;      ///< variations with variations
  Eigen::VectorXf missed;          ///< steps with the miss
  Eigen::VectorXf missed_ways;     ///< variations with the miss
};

/// Which units explain a picture with the fewest doses, and how much of each, both sides alike: a
/// search that adds, drops or exchanges one unit at a time as long as it gains, from those of
/// `before` and from none, of which the better counts. A set of units is the better the likelier
/// the picture is by it, with all it may do along the variations in which heads differ with these
/// doses (marginal likelihood), and the less its doses cost (DoseCost). `evidence` is of a state
/// without units; place and gaze are free, the turn is sure to kUnsureOfTurn. `opposite`: of each
/// channel that of the other side, or a number beyond all. Returns a dose of each channel, 0 where
/// it is none of a unit. Pure; thread: any.
std::vector<float> ChooseUnits(const SeenFace& face, const std::vector<std::size_t>& opposite,
                               const Evidence& evidence, const std::vector<float>& before);

}  // namespace facetrack
