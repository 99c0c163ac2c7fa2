#pragma once

#include <string>
#include <vector>

#include "face_space/timing/onsets.h"

namespace facespace {

/// Draws eyes, brows and mouth of tracks over time, a panel each, and where each part begins.
/// Limit: kMostPanels; further tracks are left out.
class OnsetPlot {
 public:
  static constexpr std::size_t kMostPanels = 40;
  void Add(const UnitTrack& track, const std::vector<ByRegion<double>>& courses,
           const std::vector<Onset>& onsets);
  std::string Svg() const;

 private:
  std::vector<std::string> panels_;
};

}  // namespace facespace
