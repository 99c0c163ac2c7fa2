#include "srm/engine/fit_allowance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace srm {

double Clearness(std::span<const std::int16_t> samples) {
  constexpr std::size_t kLevelFrame = 160;  // 10 ms
  std::vector<double> levels_db;
  for (; samples.size() >= kLevelFrame; samples = samples.subspan(kLevelFrame)) {
    double power = 1;
    for (const std::int16_t s : samples.first(kLevelFrame)) power += static_cast<double>(s) * s;
    levels_db.push_back(10 * std::log10(power));
  }
  if (levels_db.empty()) return 0;
  std::ranges::sort(levels_db);
  return levels_db[levels_db.size() * 9 / 10] - levels_db[levels_db.size() / 20];
}

double NoiseAllowance(double clearness_db) {
  constexpr double kQuietDb = 33, kPerDb = 1.2, kMost = 15;
  return std::clamp((kQuietDb - clearness_db) * kPerDb, 0.0, kMost);
}

double LengthAllowance(int speech_frames) {
  constexpr double kShort = 60, kPerFrame = 0.16, kMost = 8;
  return std::clamp((speech_frames - kShort) * kPerFrame, 0.0, kMost);
}

}  // namespace srm
