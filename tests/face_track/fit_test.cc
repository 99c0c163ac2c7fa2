// The parts that need no networks: bounds, turns, what the agent is told, the plot.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "face_track/fit/bounded_solve.h"
#include "face_track/fit/frame_fit.h"
#include "face_track/live/face_command.h"
#include "face_track/model/lips.h"
#include "face_track/model/seen_face.h"
#include "face_track/print/track_plot.h"

namespace facetrack {
namespace {

TEST(SeenFaceTest, AnglesComeBackFromTurns) {
  const fsm::Angles told{12, -25, 7};
  const fsm::Angles back = fsm::HeadRotationOf(TurnOf(told));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back[k], told[k], 1e-3);
}

TEST(SeenFaceTest, ATableIsReadAsItIsPrinted) {
  const std::string text = SeenFace::Shipped().Print();
  const auto again = SeenFace::Parse("t", text);
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_EQ(again->Print(), text);
}

TEST(SeenFaceTest, ADamagedVariationIsNamedWithItsLine) {
  const std::string text = SeenFace::Shipped().Print();
  const auto error = [](const std::string& damaged) {
    const auto parsed = SeenFace::Parse("t", damaged);
    return parsed ? std::string("none") : parsed.error().text;
  };
  const auto lines = std::to_string(std::ranges::count(text, '\n'));
  const std::size_t last = text.rfind("\nvaries") + 1;
  EXPECT_EQ(error(text.substr(0, last)), "t: expected a row 'varies' of gaze_rightR");
  EXPECT_NE(error(text.substr(0, text.size() - 1) + " 7\n").find("t:" + lines + ": "),
            std::string::npos);
  EXPECT_NE(error(text + text.substr(last)).find("is told twice"), std::string::npos);
  EXPECT_NE(error(text + "varies unit 99 - 1\n").find("99"), std::string::npos);
  EXPECT_NE(error(text + "varies nose 1 - 1\n").find("expected unit"), std::string::npos);
  std::string negative = text;
  negative.insert(negative.rfind(' ') + 1, "-1");
  EXPECT_NE(error(negative).find("0 or more"), std::string::npos);
  std::string cut = text;
  cut.erase(cut.find("\nremainder"),
            cut.find('\n', cut.find("\nremainder") + 1) - cut.find("\nremainder"));
  EXPECT_NE(error(cut).find("remainder"), std::string::npos);
}

/// Where the points of a face are seen that looks straight ahead.
std::vector<glm::vec2> PlacesOf(const Points& points, const Lens& lens, const Pose& pose) {
  std::vector<glm::vec2> places;
  for (std::size_t i = 0; i < kPoints; ++i) {
    places.push_back(SeenAt(SeenFace::Shipped(), lens, pose, i, points[i]));
  }
  return places;
}

/// A face that looks straight ahead, and what the fit finds of it.
class FrameFitTest : public testing::Test {
 protected:
  FrameFitTest() {
    still.doses.assign(face.channels.size(), 0);
    still.pose.place.z = -800;
  }
  /// Units of both sides at 0.7.
  Doing With(const std::vector<int>& units) const {
    Doing doing = still;
    for (std::size_t c = 0; c < face.channels.size(); ++c) {
      if (IsOneOf(units, face.channels[c])) doing.doses[c] = 0.7F;
    }
    return doing;
  }
  /// Looks for the doses of points; these units are to be there, and little else.
  void ExpectFound(const std::vector<int>& units, const Points& points, const Doing& before) const {
    const Doing found =
        FrameFit(face, lens)
            .Solve(face.rest, PlacesOf(points, lens, still.pose), before, FrameFit::What::kDoses);
    std::string told;
    for (const int unit : units) told += " " + std::to_string(unit);
    float others = 0;
    for (std::size_t c = 0; c < face.channels.size(); ++c) {
      const Channel& channel = face.channels[c];
      if (channel.kind != Channel::Kind::kUnit) continue;
      // Heads raise the upper lid (AU 5) by so different heights that its dose is told less surely.
      if (IsOneOf(units, channel))
        EXPECT_NEAR(found.doses[c], 0.7, channel.unit == 5 ? 0.17 : 0.15)
            << channel.Name() << " of" << told;
      else
        others += found.doses[c];
    }
    EXPECT_LT(others, 0.5) << told;
  }
  static bool IsOneOf(const std::vector<int>& units, const Channel& channel) {
    return channel.kind == Channel::Kind::kUnit &&
           std::ranges::find(units, channel.unit) != units.end();
  }
  const SeenFace& face = SeenFace::Shipped();
  const Lens lens = Lens::Of(400, 400, 25);
  Doing still;
};

TEST_F(FrameFitTest, AUnitOfAHeadThatMovesOtherwiseIsFoundAndLittleElse) {
  for (const int unit : {1, 2, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20, 22, 24, 25, 26, 28, 43}) {
    Points points = Moved(face, face.rest, With({unit}).doses);
    const auto channel = std::ranges::find(face.channels, unit, &Channel::unit);
    for (std::size_t k = 0; k < face.variations.size(); ++k) {
      const float by = 0.7F * channel->varies[k];
      for (std::size_t i = 0; i < kPoints; ++i) {
        points[i] += (k % 2 ? by : -by) * glm::vec3(face.variations[k][i], 0);
      }
    }
    ExpectFound({unit}, points, still);
  }
}

TEST_F(FrameFitTest, UnitsTogetherAreFoundAndWhatWasThereBeforeIsForgotten) {
  for (const std::vector<int>& units :
       {std::vector{6, 12}, std::vector{1, 2, 26}, std::vector{9, 17}, std::vector{4, 7}}) {
    const Points points = Moved(face, face.rest, With(units).doses);
    ExpectFound(units, points, still);
    ExpectFound(units, points, With({10, 14, 20}));
  }
}

TEST(MouthOfLipsTest, AMouthAtRestIsSealedAndALargerOneIsToldAlike) {
  const Points rest = SeenFace::Shipped().rest;
  const TrackedMouth still = MouthOfLips::Shipped().Mouth(LipsOf(rest, rest));
  EXPECT_EQ(still.seal, 1);
  for (const float value : still.parameters) EXPECT_EQ(value, 0);

  Points open = rest, large = rest, large_open;
  for (const std::size_t i : {14U, 87U, 317U, 17U, 84U, 314U, 152U}) open[i].y -= 10;
  for (glm::vec3& p : large) p *= 1.5F;
  for (const glm::vec3& p : open) large_open.push_back(1.5F * p);
  const Lips lips = LipsOf(open, rest), larger = LipsOf(large_open, large);
  EXPECT_LT(lips[kLowerInner], -8);
  for (std::size_t k = 0; k < kLips; ++k) EXPECT_NEAR(lips[k], larger[k], 1e-3);
}

TEST(MouthOfLipsTest, ADamagedTableIsNamed) {
  const std::string text = MouthOfLips::Shipped().Print();
  EXPECT_TRUE(MouthOfLips::Parse("t", text));
  const auto without = MouthOfLips::Parse("t", text.substr(0, text.rfind("lower_inner")));
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().text.find("lower_inner_fullness"), std::string::npos);
  EXPECT_FALSE(MouthOfLips::Parse("t", text + "seal 2 1\n"));
}

TEST(BoundedSolveTest, NoStepWithinTheBoundsIsBetter) {
  std::mt19937 chance(7);
  std::normal_distribution<float> normal;
  for (int round = 0; round < 50; ++round) {
    constexpr int kCount = 12;
    Eigen::MatrixXf rows(20, kCount);
    for (float& v : rows.reshaped()) v = normal(chance);
    rows.col(1) = rows.col(0) + 0.01F * rows.col(1);  // nearly alike
    const Eigen::MatrixXf a =
        rows.transpose() * rows + 0.1F * Eigen::MatrixXf::Identity(kCount, kCount);
    Eigen::VectorXf b(kCount);
    for (float& v : b) v = 20 * normal(chance);
    const Eigen::VectorXf low = Eigen::VectorXf::Constant(kCount, -0.2F),
                          high = Eigen::VectorXf::Constant(kCount, 1);
    const Eigen::VectorXf x = BoundedSolve(a, b, low, high);
    const auto cost = [&](const Eigen::VectorXf& v) { return 0.5F * v.dot(a * v) - b.dot(v); };
    for (int k = 0; k < kCount; ++k) {
      EXPECT_GE(x[k], low[k] - 1e-5F);
      EXPECT_LE(x[k], high[k] + 1e-5F);
      for (const float step : {-0.05F, 0.05F}) {
        Eigen::VectorXf other = x;
        other[k] = std::clamp(x[k] + step, low[k], high[k]);
        EXPECT_GE(cost(other), cost(x) - 1e-2F) << round << ' ' << k;
      }
    }
  }
}

FaceLine SomeLine() {
  FaceLine line;
  line.person = 1;
  line.units.assign(SeenFace::Shipped().channels.size(), 0);
  line.units[SeenFace::Shipped().Find("12L")] = 0.7F;
  line.head = {0, 15, 0};
  return line;
}

TEST(FaceCommandTest, InAMirrorLeftAndRightChangePlaces) {
  FaceCommand mirror(SeenFace::Shipped()), facing(SeenFace::Shipped());
  EXPECT_EQ(mirror.Next(SomeLine(), true, 40), "12R 0.70 52 0.50 40");
  EXPECT_EQ(facing.Next(SomeLine(), false, 40), "12L 0.70 51 0.50 40");
}

TEST(FaceCommandTest, OnlyWhatHasChangedIsSaidAndAllOfItGoesHome) {
  FaceCommand command(SeenFace::Shipped());
  FaceLine line = SomeLine();
  command.Next(line, true, 40);
  EXPECT_EQ(command.Next(line, true, 40), "");
  line.head[fsm::kToRight] = -15;
  EXPECT_EQ(command.Next(line, true, 33), "51 0.50 52 0.00 33");
  EXPECT_EQ(command.Rest(500), "12R 0.00 51 0.00 500");
  EXPECT_EQ(command.Rest(500), "");
}

TEST(TrackPlotTest, ALongTrackIsThinnedOut) {
  TrackPlot plot;
  FaceLine line;
  line.person = 1;
  for (int i = 0; i < 50'000; ++i) {
    line.ms = 40 * i;
    line.head = {0, i == 49'152 ? 25.0F : 0.0F, 0};
    plot.Add(line);
  }
  const std::string svg = plot.Svg();
  EXPECT_LT(svg.size(), 500'000U);
  EXPECT_NE(svg.find(">25<"), std::string::npos);
  EXPECT_NE(TrackPlot().Svg().find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace facetrack
