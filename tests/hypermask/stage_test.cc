// All of the chain on the simulated stage, whose truth is known: calibration, following,
// prediction, the face's landing.

#include <gtest/gtest.h>

#include <cmath>

#include "hypermask/calibrate/calibrator.h"
#include "hypermask/calibrate/delay_meter.h"
#include "hypermask/follow/mask_follower.h"
#include "hypermask/project/face_warp.h"
#include "hypermask/sim/trial.h"

namespace hypermask {
namespace {

const Stage& TheStage() {
  static const Stage stage;
  return stage;
}

const Calibration& TheCalibration() {
  static const auto made = CalibrateStage(TheStage(), 6, 33);
  EXPECT_TRUE(made) << made.error().text;
  return *made;
}

TEST(StageTest, TheCalibrationHitsToAPixelAtEveryDistance) {
  const Calibration& c = TheCalibration();
  EXPECT_LT(c.space_rms, 0.6);
  // One plane cannot hold for masks nearer and farther.
  EXPECT_GT(c.homography_rms, 2 * c.space_rms);
  // Poses that were not among the places.
  for (const double seconds : {0.3, 1.9, 4.4, 7.7}) {
    const Pose truth = Movement(Movement::Kind::kWalk, 3).At(seconds);
    const Points markers = Apply(TheStage().camera.Of(truth), TheStage().layout.markers);
    const auto map = MaskToProjector(c, Form::kSpace, TheStage().layout, markers);
    ASSERT_TRUE(map);
    for (const double miss : LandingDistances(TheStage(), *map, truth)) EXPECT_LT(miss, 1.2);
  }
}

TEST(StageTest, AWrongFieldOfTheCameraIsMadeUpFor) {
  const auto made = CalibrateStage(TheStage(), 6, 40);
  ASSERT_TRUE(made) << made.error().text;
  const Pose truth = Movement(Movement::Kind::kWalk, 3).At(4.4);
  const Points markers = Apply(TheStage().camera.Of(truth), TheStage().layout.markers);
  const auto map = MaskToProjector(*made, Form::kSpace, TheStage().layout, markers);
  ASSERT_TRUE(map);
  for (const double miss : LandingDistances(TheStage(), *map, truth)) EXPECT_LT(miss, 3);
}

TEST(StageTest, WhatMakesNoCalibrationIsSaid) {
  const auto few = CalibrateStage(TheStage(), 2, 33);
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().text, "the mask was held still in 2 places, expected at least 3");

  const Stage& stage = TheStage();
  const StageCamera camera(stage);
  const MarkerFinder finder(stage.layout);
  const DotPattern pattern(1280, 720);
  const Movement movement(Movement::Kind::kPlaces, 1);
  std::vector<Grey> pictures(pattern.frames());
  const auto see = [&](const Pose& mask, std::size_t frame, unsigned hidden, bool light) {
    const fsm::Image shown = pattern.Frame(frame);
    camera.See(mask, mask, static_cast<std::uint32_t>(frame), hidden, light ? &shown : nullptr,
               pictures[frame]);
  };
  const Pose here = movement.At(1), there = movement.At(Movement::kHoldSeconds + 1);
  for (std::size_t f = 0; f < pictures.size(); ++f) see(here, f, 0, true);
  const auto place = ReadPlace(pattern, pictures, finder);
  ASSERT_TRUE(place) << place.error().text;
  EXPECT_GT(place->seen.size(), 25U);
  const auto plane =
      Calibrate({*place, *place, *place}, stage.layout, Pinhole::OfField(640, 480, 33), 1280, 720);
  ASSERT_FALSE(plane);
  EXPECT_NE(plane.error().text.find("lie in one plane"), std::string::npos);

  see(there, pictures.size() - 1, 0, true);
  const auto moved = ReadPlace(pattern, pictures, finder);
  ASSERT_FALSE(moved);
  EXPECT_NE(moved.error().text.find("the mask moved by"), std::string::npos) << moved.error().text;

  for (std::size_t f = 0; f < pictures.size(); ++f) see(here, f, 0, false);
  const auto filtered = ReadPlace(pattern, pictures, finder);
  ASSERT_FALSE(filtered);
  EXPECT_NE(filtered.error().text.find("sees 0 projected dots"), std::string::npos)
      << filtered.error().text;

  for (std::size_t f = 0; f < pictures.size(); ++f) see(here, f, ~0u, true);
  const auto covered = ReadPlace(pattern, pictures, finder);
  ASSERT_FALSE(covered);
  EXPECT_NE(covered.error().text.find("5 markers are not seen"), std::string::npos)
      << covered.error().text;
}

TEST(StageTest, EveryDotOfThePatternTellsWhichItIs) {
  const DotPattern pattern(320, 240);
  std::vector<fsm::Image> frames;
  for (std::size_t f = 0; f < pattern.frames(); ++f) frames.push_back(pattern.Frame(f));
  const auto lit = [&](const fsm::Image& frame, int x, int y) {
    return frame.rgba[4 * frame.Index(x, y)] != 0;
  };
  int dots = 0;
  for (int y = DotPattern::kSpacing / 2; y < 240 - 6; y += DotPattern::kSpacing) {
    for (int x = DotPattern::kSpacing / 2; x < 320 - 6; x += DotPattern::kSpacing) {
      if (!lit(frames[1], x, y)) continue;
      std::vector<bool> code;
      for (std::size_t f = 2; f + 1 < frames.size(); ++f) code.push_back(lit(frames[f], x, y));
      const auto place = pattern.Decode(code);
      ASSERT_TRUE(place);
      EXPECT_EQ(*place, Point(x, y));
      code[0] = !code[0];  // one misread bit is no other dot
      EXPECT_FALSE(pattern.Decode(code));
      ++dots;
    }
  }
  EXPECT_EQ(dots, 12 * 9);
}

class TrialTest : public testing::TestWithParam<Movement::Kind> {};

TEST_P(TrialTest, PredictionMakesUpForTheDelay) {
  const SimSettings settings{.movement = GetParam(), .seed = 21};
  const auto results = RunTrial(TheStage(), TheCalibration(), settings, 15,
                                {{Prediction::kOff, Form::kSpace, 0},
                                 {Prediction::kOff, Form::kSpace, 100},
                                 {Prediction::kSingle, Form::kSpace, 100},
                                 {Prediction::kBank, Form::kSpace, 100},
                                 {Prediction::kBank, Form::kSpace, 0},
                                 {Prediction::kBank, Form::kAffine, 0}});
  const auto rms = [&](std::size_t i) { return results[i].error.rms; };
  EXPECT_GT(rms(1), 2.5 * rms(0));
  EXPECT_LT(rms(2), rms(1));
  EXPECT_LT(rms(3), 0.6 * rms(1));
  EXPECT_LT(rms(4), 2);
  EXPECT_GT(rms(5), rms(4));
}

INSTANTIATE_TEST_SUITE_P(Movements, TrialTest,
                         testing::Values(Movement::Kind::kSway, Movement::Kind::kWalk,
                                         Movement::Kind::kShake, Movement::Kind::kTurn),
                         [](const auto& of) { return std::string(Movement::NameOf(of.param)); });

TEST(StageTest, AMaskThatWasCoveredIsFoundAgainAtOnce) {
  const Stage& stage = TheStage();
  const StageCamera camera(stage);
  for (const auto kind : {Movement::Kind::kSway, Movement::Kind::kWalk, Movement::Kind::kTurn}) {
    const SimSettings settings{.movement = kind, .seed = 4, .cover_each_s = 2};
    const Movement movement(kind, settings.seed);
    MaskFollower follower(stage.layout, {});
    Grey picture;
    int blind = 0, longest = 0, partly = 0;
    for (std::uint32_t number = 0; number < 500; ++number) {
      const double now = number / 60.0;
      const unsigned covered = CoveredMarkers(settings, now);
      camera.See(movement.At(now), movement.At(now), number, covered, nullptr, picture);
      const std::size_t seen = follower.Look(picture, now);
      if (covered == ~0u) {
        EXPECT_EQ(seen, 0U);
        continue;
      }
      partly += covered != 0 && seen == 4 ? 1 : 0;
      blind = seen == 0 ? blind + 1 : 0;
      longest = std::max(longest, blind);
      if (seen == 0) continue;
      const Points truth = Apply(stage.camera.Of(movement.At(now)), stage.layout.markers);
      for (std::size_t i = 0; i < truth.size(); ++i) {
        EXPECT_LT((follower.markers()[i] - truth[i]).norm(), 2) << number;
      }
    }
    EXPECT_LE(longest, 1) << Movement::NameOf(kind);
    EXPECT_GE(partly, 50) << Movement::NameOf(kind);
    EXPECT_TRUE(follower.following());
  }
}

TEST(StageTest, AfterAQuarterOfASecondAMaskThatIsGoneIsNoLongerForetold) {
  const Stage& stage = TheStage();
  const StageCamera camera(stage);
  const Pose mask = Movement(Movement::Kind::kStill, 1).At(0);
  MaskFollower follower(stage.layout, {});
  Grey picture;
  for (std::uint32_t number = 0; number < 60; ++number) {
    const double now = number / 60.0;
    camera.See(mask, mask, number, now < 0.5 ? 0 : ~0u, nullptr, picture);
    follower.Look(picture, now);
    EXPECT_EQ(follower.At(now + 0.1).has_value(), now < 0.5 + MaskFollower::kPatience - 0.01)
        << now;
  }
}

// What the program draws for the projector, seen by the audience's eye: the face's picture, whose
// middle is red, must be where the layout has the middle of the picture.
TEST(StageTest, TheFaceIsSeenWhereTheMaskIs) {
  const Stage& stage = TheStage();
  fsm::Image face = fsm::FilledImage(200, 200, {200, 200, 200, 255});
  for (int y = 90; y < 110; ++y) {
    for (int x = 90; x < 110; ++x) {
      const std::size_t at = 4 * face.Index(x, y);
      face.rgba[at + 1] = face.rgba[at + 2] = 0;
    }
  }
  FaceWarp warp(stage.layout, 1280, 720);
  warp.SetFace(face);
  const StageView view(stage);
  for (const double seconds : {0.5, 2.9, 6.1}) {
    const Pose mask = Movement(Movement::Kind::kTurn, 8).At(seconds);
    const PlaneMap map = stage.projector.Of(mask);
    fsm::Image seen;
    view.See(mask, warp.Draw(&map), seen);
    const Point middle = Apply(stage.audience.Of(mask), stage.layout.picture);
    double red = 0;
    Point sum(0, 0);
    for (int y = 0; y < seen.height; ++y) {
      for (int x = 0; x < seen.width; ++x) {
        const std::uint8_t* const p = &seen.rgba[4 * seen.Index(x, y)];
        if (p[0] < 150 || p[1] > p[0] / 2) continue;  // markers are darker
        sum += Point(x, y);
        ++red;
      }
    }
    ASSERT_GT(red, 20);
    EXPECT_LT((sum / red - middle).norm(), 1) << seconds;
  }
  // Nothing beside the oval is lit.
  const PlaneMap map = stage.projector.Of(Movement(Movement::Kind::kStill, 1).At(0));
  const fsm::Image& drawn = warp.Draw(&map);
  const Point beside = Apply(map, Point(stage.layout.oval.x() + 5, 0));
  EXPECT_EQ(drawn.rgba[4 * drawn.Index(static_cast<int>(beside.x()), static_cast<int>(beside.y()))],
            0);
  const fsm::Image& dark = warp.Draw(nullptr);
  EXPECT_EQ(dark.rgba[4 * dark.Index(640, 360)], 0);
}

TEST(StageTest, AMovementIsTheSameAtEachCallAndHasNoJumps) {
  for (const auto kind : {Movement::Kind::kSway, Movement::Kind::kWalk, Movement::Kind::kShake,
                          Movement::Kind::kTurn}) {
    const Movement movement(kind, 7);
    for (double t = 0; t < 20; t += 1.0 / 240) {
      const Pose now = movement.At(t), next = movement.At(t + 1.0 / 240);
      EXPECT_LT((next.position - now.position).norm(), 8) << Movement::NameOf(kind) << " " << t;
      EXPECT_LT((next.rotation - now.rotation).norm(), 0.03) << Movement::NameOf(kind) << " " << t;
      EXPECT_EQ(movement.At(t).position, now.position);
    }
  }
}

TEST(DelayMeterTest, TheDelayIsFoundToAFewMilliseconds) {
  for (const double truth : {0.0, 37.0, 120.0, 430.0}) {
    DelayMeter meter;
    std::vector<std::pair<double, bool>> shown;
    bool on = true;
    for (double ms = 0; ms < 7000; ms += meter.NextHoldMs()) {
      on = !on;
      meter.Shown(ms, on);
      shown.emplace_back(ms, on);
    }
    for (double ms = 0; ms < 7000; ms += 1000.0 / 30) {
      bool lit = false;
      for (const auto& [from, state] : shown) {
        if (from <= ms - truth) lit = state;
      }
      meter.Seen(ms, (lit ? 60 : 20) + 3 * std::sin(ms));
    }
    const auto delay = meter.Delay();
    ASSERT_TRUE(delay) << delay.error().text;
    EXPECT_NEAR(*delay, truth, 6) << truth;
  }
}

TEST(DelayMeterTest, WhatCannotBeMeasuredIsSaid) {
  DelayMeter none;
  EXPECT_NE(none.Delay().error().text.find("gave 0 pictures"), std::string::npos);
  DelayMeter blind;
  bool on = false;
  for (double ms = 0; ms < 7000; ms += blind.NextHoldMs()) blind.Shown(ms, on = !on);
  for (double ms = 0; ms < 7000; ms += 16) blind.Seen(ms, 20 + 5 * std::sin(0.31 * ms));
  ASSERT_FALSE(blind.Delay());
  EXPECT_NE(blind.Delay().error().text.find("does not see the projector's flashes"),
            std::string::npos);
}

}  // namespace
}  // namespace hypermask
