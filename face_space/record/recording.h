#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "face_space/record/track.h"
#include "vm_protocol/core/result.h"

namespace facespace {

/// Places of markers on a face over time. A plain value.
struct Recording {
  std::string name;
  std::vector<std::string> markers;
  std::vector<double> ms;
  /// 3 markers x frames, mm: x, y, z of the first marker, then of the next.
  Eigen::MatrixXd places;

  Eigen::Index count() const { return places.rows() / 3; }
  Eigen::Index frames() const { return places.cols(); }
};

/// Fewest markers of which a recording can be made: below, the head's motion cannot be told from
/// the face's.
inline constexpr Eigen::Index kFewestMarkers = 8, kMostMarkers = 600;

/// Whether the columns of a track are places of markers.
bool HasMarkers(const Track& track);
/// The markers of a track: columns NAME_x NAME_y NAME_z (or NAME.x, NAME:X), or xN yN zN as
/// face_track names them; other columns are left out. `mm`: how many millimetres one of its unit
/// is. Errors: kBadValue naming the recording: a marker without one of its three columns, fewer
/// than kFewestMarkers or more than kMostMarkers.
vm::Result<Recording> MarkersOf(const Track& track, double mm = 1);

/// Recordings that belong together must have the same markers. Brings those of `recording` into the
/// order of `first`. Error: kBadValue naming both and the difference.
vm::Result<void> OrderAs(const Recording& first, Recording& recording);

}  // namespace facespace
