#pragma once

#include <string>
#include <vector>

#include "face_track/follow/face_line.h"
#include "vm_protocol/core/result.h"

namespace facetrack {

/// A track over time as an SVG picture: the head's angles, the lids, the jaw. At most kMostPoints
/// lines are kept: of longer tracks each second, fourth, ... one.
class TrackPlot {
 public:
  static constexpr std::size_t kMostPoints = 4000;
  void Add(const FaceLine& line);
  std::string Svg() const;
  /// Error: kUnavailable.
  vm::Result<void> Write(const std::string& path) const;

 private:
  struct Moment {
    double ms;
    bool seen;
    float values[6];
  };
  std::vector<Moment> moments_;
  std::size_t lines_ = 0, every_ = 1;
};

}  // namespace facetrack
