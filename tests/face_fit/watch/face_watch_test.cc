// What FaceWatch says of images of the built-in head, beside what the head was told to do.

#include "face_fit/watch/face_watch.h"

#include <gtest/gtest.h>

#include <sstream>
#include <utility>
#include <vector>

#include "face_fit/find/head/portrait_view.h"
#include "tests/face_fit/network_fixture.h"
#include "tests/face_fit/tflite/one_node.h"
#include "tests/support/process.h"

namespace facefit {
namespace {

/// A network with the outputs of that with attention, which sees a face nowhere.
tflite::Network SeesNoFace() {
  const tflite::Shape image{{1, kLandmarkInputPixels, kLandmarkInputPixels, 3}};
  tflite::Model model = tflite::OneNode(tflite::op::Logistic{}, image, {}, image);
  model.outputs.clear();
  for (const int count : {3 * static_cast<int>(kNetworkPoints), 160, 142, 142, 10, 10, 1}) {
    model.outputs.push_back(static_cast<int>(model.tensors.size()));
    std::vector<float> values(static_cast<std::size_t>(count), -5);
    model.tensors.push_back(tflite::Constant({{1, 1, 1, count}}, std::move(values)));
  }
  return tflite::Network(std::move(model));
}

class FaceWatchTest : public AttentionNetworkTest {
 protected:
  void SetUp() override {
    AttentionNetworkTest::SetUp();
    if (!attention_) return;
    watch_.emplace(*networks_, *attention_);
    rest_ = See({});
  }
  fsm::Image Draw(const fsm::FaceState& state) {
    fsm::HeadVertices vertices;
    Galatea().head().Evaluate(state, vertices);
    return portrait_.Draw(Galatea().head(), vertices, state);
  }
  FaceMeasures See(const fsm::FaceState& state) {
    const auto seen = watch_->MeasureNext(Draw(state));
    EXPECT_TRUE(seen) << "a face is seen";
    return seen.value_or(FaceMeasures{});
  }

  const PortraitView portrait_{400};
  std::optional<FaceWatch> watch_;
  FaceMeasures rest_;
};

TEST_F(FaceWatchTest, TheGapOfTheLipsIsSeenToAThird) {
  EXPECT_LT(rest_.gap_mm, 0.5F) << "closed";
  for (const float jaw : {3.0F, 6.0F, 10.0F}) {
    fsm::FaceState state;
    state.mouth[fsm::kJawY] = jaw;
    const float told = Galatea().head().MeasureMouth(state).gap_mm;
    EXPECT_NEAR(See(state).gap_mm, told, 0.35F * told) << jaw;
  }
}

TEST_F(FaceWatchTest, TheWidthOfTheMouthIsSeen) {
  fsm::FaceState wide, narrow;
  wide.mouth[fsm::kCornerX] = 3.5F;
  narrow.mouth[fsm::kCornerX] = -5;
  const float told =
      Galatea().head().MeasureMouth(wide).width_mm - Galatea().head().MeasureMouth(narrow).width_mm;
  EXPECT_NEAR(See(wide).width_mm - See(narrow).width_mm, told, 0.3F * told);
}

TEST_F(FaceWatchTest, ShutEyesAreSeen) {
  fsm::FaceState state;
  state.blink.left = state.blink.right = 1;
  const FaceMeasures shut = See(state);
  for (const fsm::Side side : fsm::kSides) {
    EXPECT_GT(rest_.eye_mm[side], 8);
    EXPECT_LT(shut.eye_mm[side], 0.4F * rest_.eye_mm[side]);
  }
  state.blink.left = 0;
  const FaceMeasures wink = See(state);
  EXPECT_LT(wink.eye_mm.right, 0.6F * wink.eye_mm.left);
}

TEST_F(FaceWatchTest, TurnsOfTheHeadHaveTheirSignsAndSizes) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float by : {-8.0F, 8.0F}) {
      fsm::FaceState state;
      state.head_rotation[static_cast<std::size_t>(axis)] = by;
      const FaceMeasures seen = See(state);
      for (int other = 0; other < 3; ++other) {
        EXPECT_NEAR(seen.turn_deg[other], other == axis ? by : 0, 4.5)
            << "axis " << axis << ", " << by;
      }
      EXPECT_LT(seen.gap_mm, 1) << "lips stay closed while the head turns";
    }
  }
}

TEST_F(FaceWatchTest, BrowsAndCornersMoveAsUnitsSay) {
  fsm::FaceState brows, smile;
  for (const std::size_t unit : {1U, 2U}) brows.au.left[unit] = brows.au.right[unit] = 1;
  smile.au.left[12] = 1;
  const FaceMeasures raised = See(brows), smiling = See(smile);
  for (const fsm::Side side : fsm::kSides) {
    EXPECT_GT(raised.brow_inner_mm[side], rest_.brow_inner_mm[side] + 2) << fsm::SignOf(side);
    EXPECT_GT(raised.brow_outer_mm[side], rest_.brow_outer_mm[side] + 2) << fsm::SignOf(side);
  }
  EXPECT_GT(smiling.corner_up_mm.left, rest_.corner_up_mm.left + 3);
  EXPECT_LT(smiling.corner_up_mm.right, rest_.corner_up_mm.right + 2);
}

TEST_F(FaceWatchTest, AFaceThatGoesAndComesBackIsFoundAgain) {
  EXPECT_FALSE(watch_->MeasureNext(fsm::FilledImage(400, 400)));
  EXPECT_FALSE(watch_->last());
  EXPECT_LT(See({}).gap_mm, 0.5F);
}

TEST_F(FaceWatchTest, AFaceWhosePointsAreUncertainIsNotSeen) {
  AttentionNetwork blind(SeesNoFace());
  FaceWatch watch(*networks_, blind);
  for (int frame = 0; frame < 2; ++frame) {
    EXPECT_FALSE(watch.MeasureNext(Draw({})));
    EXPECT_FALSE(watch.last());
  }
}

/// The program: frames in, a line each out.
TEST_F(FaceWatchTest, TheProgramPrintsALineForEachFrame) {
  const fsm::Image face = Draw({}), none = fsm::FilledImage(400, 400);
  support::Process program({GALATEA_BIN_DIR "/face_watch", "--size", "400x400", "--rate", "50"});
  for (const fsm::Image* image : {&face, &none}) {
    program.Write({reinterpret_cast<const char*>(image->rgba.data()), image->rgba.size()});
  }
  program.CloseInput();
  const auto lines = program.ReadAll();
  EXPECT_EQ(program.Wait(), 0) << program.ErrorText();
  ASSERT_EQ(lines.size(), 3U);
  const auto commas = std::ranges::count(lines[0], ',');
  EXPECT_TRUE(lines[1].starts_with("0.0,1.000,0.")) << lines[1];
  EXPECT_TRUE(lines[2].starts_with("20.0,0,,")) << lines[2];
  for (const auto& line : lines) EXPECT_EQ(std::ranges::count(line, ','), commas) << line;
}

/// Halved until its longer side is right for the detector, such an image has no columns left.
TEST_F(FaceWatchTest, AnImageFarHigherThanWideShowsNoFace) {
  constexpr int kWide = 16, kHigh = 8192;
  support::Process program({GALATEA_BIN_DIR "/face_watch", "--size", "16x8192"});
  program.Write(std::string(4 * kWide * kHigh, '\x5a'));
  program.CloseInput();
  const auto lines = program.ReadAll();
  EXPECT_EQ(program.Wait(), 0) << program.ErrorText();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_TRUE(lines[1].starts_with("0.0,0,,")) << lines[1];
}

TEST(FaceWatchProgramTest, WhatIsNoFilmIsOneError) {
  support::Process cut({GALATEA_BIN_DIR "/face_watch", "--size", "32x16"});
  cut.Write(std::string(100, 'x'));
  cut.CloseInput();
  EXPECT_EQ(cut.Wait(), 1);
  if (!cut.ExpectError("networks")) {
    EXPECT_TRUE(cut.ExpectError("standard input ends within frame 0: it has 100 of 2048 bytes"))
        << cut.ErrorText();
  }
  support::Process size({GALATEA_BIN_DIR "/face_watch", "--size", "32by16"});
  EXPECT_EQ(size.Wait(), 1);
  EXPECT_TRUE(size.ExpectError("--size '32by16': expected WIDTHxHEIGHT")) << size.ErrorText();
}

}  // namespace
}  // namespace facefit
