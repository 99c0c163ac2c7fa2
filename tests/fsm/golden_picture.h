#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "fsm/image/image_file.h"

namespace fsm {

/// How far two pictures of a figure before one background are apart. Only pixels that differ from
/// the background in either picture count, so that a small figure is not measured by what is empty
/// around it. Levels of 0..255.
struct FigureDifference {
  std::size_t figure = 0;  ///< pixels that count
  double mean = 0;         ///< over them and the colour channels
  int percentile_995 = 0;  ///< of the channel that is most off: 5 pixels in 1000 are farther off
  /// The mean of the worst tile of kTile x kTile pixels: what is wrong in one place only.
  double worst_tile = 0;
  std::array<int, 2> worst_at{};  ///< the upper left pixel of that tile

  static constexpr int kTile = 11;
};

/// REQUIRES: both of one size; `background` is 0..1.
inline FigureDifference CompareFigures(const Image& a, const Image& b, glm::vec3 background) {
  constexpr int kRounding = 2;  // levels by which the background may be off
  const auto shows = [&](const Image& image, std::size_t i) {
    for (int c = 0; c < 3; ++c) {
      const auto level = static_cast<int>(255 * background[c] + 0.5F);
      if (std::abs(image.rgba[i + static_cast<std::size_t>(c)] - level) > kRounding) return true;
    }
    return false;
  };
  constexpr int kTile = FigureDifference::kTile;
  const int across = (a.width + kTile - 1) / kTile;
  std::vector<double> tiles(static_cast<std::size_t>(across * ((a.height + kTile - 1) / kTile)));
  std::vector<int> most_off;
  FigureDifference difference;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    if (!shows(a, i) && !shows(b, i)) continue;
    int most = 0;
    double sum = 0;
    for (std::size_t c = i; c < i + 3; ++c) {
      const int off = std::abs(a.rgba[c] - b.rgba[c]);
      most = std::max(most, off);
      sum += off;
    }
    most_off.push_back(most);
    difference.mean += sum / 3;
    const int x = static_cast<int>(i / 4) % a.width, y = static_cast<int>(i / 4) / a.width;
    tiles[static_cast<std::size_t>(y / kTile * across + x / kTile)] += sum / 3 / (kTile * kTile);
  }
  difference.figure = most_off.size();
  if (most_off.empty()) return difference;
  difference.mean /= static_cast<double>(most_off.size());
  const auto rank = static_cast<std::ptrdiff_t>(most_off.size() * 995 / 1000);
  std::ranges::nth_element(most_off, most_off.begin() + rank);
  difference.percentile_995 = most_off[static_cast<std::size_t>(rank)];
  const auto worst = std::ranges::max_element(tiles);
  difference.worst_tile = *worst;
  const auto at = static_cast<int>(worst - tiles.begin());
  difference.worst_at = {at % across * kTile, at / across * kTile};
  return difference;
}

/// How far off a kept picture may be. Another of Mesa's drivers (softpipe for llvmpipe, EGL for
/// OSMesa) rounds otherwise by 0.12, 1 and 0.32 at most; a jaw that drops 10 % less, a corner of
/// the mouth 1 mm off, a gaze 4 degrees off or colours raised to the power of 1.05 are beyond one
/// of the limits wherever they are seen.
struct GoldenLimits {
  double mean = 0.5;
  int percentile_995 = 8;
  double worst_tile = 2.5;
};

/// Compares a picture with the one kept at `path`; with GALATEA_RENEW_GOLDENS set in the
/// environment it is kept instead, and the test is skipped.
inline void ExpectGolden(const Image& now, const std::string& path, glm::vec3 background,
                         const GoldenLimits& limits = {}) {
  if (std::getenv("GALATEA_RENEW_GOLDENS") != nullptr) {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    const auto written = WriteImage(now, path);
    ASSERT_TRUE(written) << written.error().text;
    GTEST_SKIP() << "renewed " << path;
  }
  const auto kept = ReadImage(path);
  ASSERT_TRUE(kept) << kept.error().text;
  ASSERT_EQ(kept->width, now.width);
  ASSERT_EQ(kept->height, now.height);
  const FigureDifference off = CompareFigures(*kept, now, background);
  const std::string name = std::filesystem::path(path).stem();
  const auto explain = [&] {
    const std::string drawn = ::testing::TempDir() + name + "_now.png";
    const auto written = WriteImage(now, drawn);
    return "worst round pixel " + std::to_string(off.worst_at[0]) + "," +
           std::to_string(off.worst_at[1]) + "; the picture drawn now is " +
           (written ? drawn : "not kept: " + written.error().text);
  };
  std::printf("%-14s %5zu pixels: mean %.2f, 99.5 %% within %d, worst tile %.2f\n", name.c_str(),
              off.figure, off.mean, off.percentile_995, off.worst_tile);
  EXPECT_LE(off.mean, limits.mean) << explain();
  EXPECT_LE(off.percentile_995, limits.percentile_995) << explain();
  EXPECT_LE(off.worst_tile, limits.worst_tile) << explain();
}

}  // namespace fsm
