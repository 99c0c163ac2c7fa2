// Which spot is which marker, and where the markers will be.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "hypermask/follow/mask_follower.h"
#include "hypermask/geometry/pinhole.h"

namespace hypermask {
namespace {

const Pinhole kCamera = Pinhole::OfField(640, 480, 33);

Pose Turned(double yaw, double pitch, double roll, Eigen::Vector3d place = {0, 0, 2000}) {
  const double d = std::numbers::pi / 180;
  return {(Eigen::AngleAxisd(roll * d, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(yaw * d, Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(pitch * d, Eigen::Vector3d::UnitX()))
              .toRotationMatrix(),
          std::move(place)};
}

Points MarkersOf(const Pose& pose) {
  return Apply(PlaneToPicture(kCamera, pose), MaskLayout::Default().markers);
}

std::vector<Spot> SpotsAt(const Points& places) {
  std::vector<Spot> spots;
  for (const Point& place : places) spots.push_back({.place = place, .weight = 1000, .pixels = 9});
  return spots;
}

double Farthest(const Points& a, const Points& b) {
  double most = a.size() == b.size() ? 0 : 1e9;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    most = std::max(most, (a[i] - b[i]).norm());
  }
  return most;
}

// The papers' range: any turn in the picture, 20 degrees up and down, 30 to the sides.
TEST(MarkerFinderTest, MarkersAreToldApartInAllOfThePapersRange) {
  const MarkerFinder finder(MaskLayout::Default());
  for (int roll = 0; roll < 360; roll += 30) {
    for (int yaw = -30; yaw <= 30; yaw += 15) {
      for (int pitch = -20; pitch <= 20; pitch += 20) {
        const Points truth = MarkersOf(Turned(yaw, pitch, roll));
        Points shuffled{truth[3], truth[0], truth[4], truth[2], truth[1]};
        shuffled.emplace_back(30, 40);  // a lamp
        const auto found = finder.Search(SpotsAt(shuffled));
        ASSERT_TRUE(found) << roll << " " << yaw << " " << pitch;
        EXPECT_EQ(found->seen, 5U);
        EXPECT_LT(Farthest(found->places, truth), 1e-9) << roll << " " << yaw << " " << pitch;
      }
    }
  }
}

TEST(MarkerFinderTest, OtherSpotsAreNoMask) {
  const MarkerFinder finder(MaskLayout::Default());
  EXPECT_FALSE(finder.Search({}));
  Points truth = MarkersOf(Turned(0, 0, 0));
  // Corners without the fifth could be any window.
  EXPECT_FALSE(finder.Search(SpotsAt({truth[0], truth[1], truth[2], truth[3]})));
  truth[4] = {5, 5};
  EXPECT_FALSE(finder.Search(SpotsAt(truth)));
}

TEST(MarkerFinderTest, CoveredMarkersAreWhereTheOthersSay) {
  const MarkerFinder finder(MaskLayout::Default());
  const Points truth = MarkersOf(Turned(20, -10, 15));
  Points expected = truth;
  for (Point& place : expected) place += Point(4, -3);
  for (std::size_t covered = 0; covered < 5; ++covered) {
    Points left = truth;
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(covered));
    const auto found = finder.Follow(SpotsAt(left), expected, 10);
    ASSERT_TRUE(found) << covered;
    EXPECT_EQ(found->seen, 4U);
    EXPECT_LT(Farthest(found->places, truth), 1e-6) << covered;
  }
  const auto three = finder.Follow(SpotsAt({truth[0], truth[1], truth[2]}), expected, 10);
  ASSERT_TRUE(three);
  EXPECT_LT(Farthest(three->places, truth), 6);  // an affine view of a turned mask
  EXPECT_FALSE(finder.Follow(SpotsAt({truth[0], truth[1]}), expected, 10));
}

TEST(SpotsTest, TheMiddleOfASpotIsFoundToATenthOfAPixel) {
  for (const double shift : {0.0, 0.25, 0.5, 0.75}) {
    Grey picture(64, 48, 10);
    const Point truth(30 + shift, 20.4 - shift);
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        const double glow = 330 * std::exp(-(Point(x, y) - truth).squaredNorm() / (2 * 1.5 * 1.5));
        picture.pixels[picture.Index(x, y)] = static_cast<std::uint8_t>(std::min(255.0, 10 + glow));
      }
    }
    const auto spots = FindSpots(picture, {});
    ASSERT_EQ(spots.size(), 1U);
    EXPECT_LT((spots[0].place - truth).norm(), 0.1);
  }
}

TEST(SpotsTest, DarkPicturesAndLampsHaveNone) {
  EXPECT_TRUE(FindSpots(Grey(64, 48, 0), {}).empty());
  EXPECT_TRUE(FindSpots(Grey(64, 48, 200), {}).empty());
  EXPECT_TRUE(FindSpots(Grey(1, 1, 200), {}).empty());
  Grey lamp(200, 200, 10);
  for (int y = 50; y < 150; ++y) {
    for (int x = 50; x < 150; ++x) lamp.pixels[lamp.Index(x, y)] = 255;
  }
  EXPECT_TRUE(FindSpots(lamp, {}).empty());
}

/// The error of what is foretold `ahead` of a coordinate that moves so, root of mean square.
double ErrorOf(Prediction kind, double ahead, const std::function<double(double)>& place) {
  Predictor predictor(kind, ahead);
  std::mt19937 random(5);
  double sum = 0, count = 0;
  for (int i = 0; i < 600; ++i) {
    const double now = i / 60.0;
    const double noise = 0.1 * (static_cast<double>(random()) / 4294967296.0 - 0.5);
    predictor.Measure(now, {Point(place(now) + noise, 100)});
    if (i < 120) continue;
    sum += std::pow(predictor.At(now + ahead)[0].x() - place(now + ahead), 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(PredictorTest, SteadySpeedIsForetold) {
  const auto steady = [](double t) { return 50 * t; };
  EXPECT_NEAR(ErrorOf(Prediction::kOff, 0.1, steady), 5, 0.2);
  EXPECT_LT(ErrorOf(Prediction::kSingle, 0.1, steady), 0.5);
  EXPECT_LT(ErrorOf(Prediction::kBank, 0.1, steady), 0.5);
}

TEST(PredictorTest, OfASwingTheBankForetellsMoreThanOneFilter) {
  const auto swing = [](double t) { return 20 * std::sin(2 * std::numbers::pi * 1.7 * t); };
  const double off = ErrorOf(Prediction::kOff, 0.1, swing);
  EXPECT_LT(ErrorOf(Prediction::kSingle, 0.1, swing), off);
  EXPECT_LT(ErrorOf(Prediction::kBank, 0.1, swing), 0.25 * off);
}

TEST(PredictorTest, WhatStandsStillStaysThere) {
  EXPECT_LT(ErrorOf(Prediction::kBank, 0.15, [](double) { return 320.0; }), 0.2);
}

TEST(PredictorTest, AfterAGapNothingIsKnownOfSpeeds) {
  Predictor predictor(Prediction::kBank, 0.1);
  for (int i = 0; i < 60; ++i) predictor.Measure(i / 60.0, {Point(10 * i, 0)});
  predictor.Measure(5, {Point(300, 0)});
  EXPECT_NEAR(predictor.At(5.1)[0].x(), 300, 1e-6);
  // Times that do not go on are a new beginning, too.
  predictor.Measure(4, {Point(200, 0)});
  EXPECT_NEAR(predictor.At(4.1)[0].x(), 200, 1e-6);
}

}  // namespace
}  // namespace hypermask
