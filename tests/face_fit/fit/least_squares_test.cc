#include "face_fit/fit/least_squares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace facefit {
namespace {

TEST(LinearLeastSquaresTest, TheLineThroughPointsIsTheOneOfTheBooks) {
  // Anscombe, Graphs in Statistical Analysis, 1973, first set: y = 3.00 + 0.500 x.
  constexpr std::pair<double, double> kPoints[] = {{10, 8.04},  {8, 6.95},  {13, 7.58}, {9, 8.81},
                                                   {11, 8.33},  {14, 9.96}, {6, 7.24},  {4, 4.26},
                                                   {12, 10.84}, {7, 4.82},  {5, 5.68}};
  LinearLeastSquares line;
  for (const auto& [x, y] : kPoints) line.Add({1, x}, y);
  const auto solved = line.Solve(1e-9);
  EXPECT_NEAR(solved[0], 3.00, 0.005);
  EXPECT_NEAR(solved[1], 0.500, 0.001);
}

TEST(LinearLeastSquaresTest, WhatNoEquationTellsOfStaysAtZero) {
  LinearLeastSquares sum;
  sum.Add({2, 0}, 6);
  sum.Add({1, 0}, 3);
  const auto solved = sum.Solve(1e-6);
  EXPECT_NEAR(solved[0], 3, 1e-5);
  EXPECT_EQ(solved[1], 0);
}

/// Rosenbrock's valley (The Computer Journal 3, 1960): its floor is at (1, 1). Newton's steps
/// alone leave it at once.
std::vector<double> Rosenbrock(const std::vector<double>& p) {
  return {10 * (p[1] - p[0] * p[0]), 1 - p[0]};
}

TEST(LevenbergMarquardtTest, RosenbrocksValleyIsFollowedToItsFloor) {
  const auto found = LevenbergMarquardt(
      Rosenbrock, {{.start = -1.2, .step = 1e-6}, {.start = 1, .step = 1e-6}}, 99);
  EXPECT_NEAR(found[0], 1, 1e-3);
  EXPECT_NEAR(found[1], 1, 1e-3);
}

TEST(LevenbergMarquardtTest, AnUnknownAtItsBoundStaysThereAndTheOthersSettle) {
  // With x held at 0.5 or below, the floor of the valley is at y = 0.25.
  const auto found = LevenbergMarquardt(
      Rosenbrock, {{.start = -1, .step = 1e-6, .low = -2, .high = 0.5}, {.start = 1, .step = 1e-6}},
      99);
  EXPECT_NEAR(found[0], 0.5, 1e-6);
  EXPECT_NEAR(found[1], 0.25, 1e-3);
}

TEST(LevenbergMarquardtTest, AStartThatIsBestStays) {
  const auto found =
      LevenbergMarquardt(Rosenbrock, {{.start = 1, .step = 1e-6}, {.start = 1, .step = 1e-6}}, 9);
  EXPECT_EQ(found[0], 1);
  EXPECT_EQ(found[1], 1);
}

}  // namespace
}  // namespace facefit
