// A photo whose truth is known: another built-in head, drawn. What is fitted to the picture is
// compared with the head it was drawn from.

#include <gtest/gtest.h>

#include <cstdio>
#include <glm/geometric.hpp>
#include <optional>

#include "face_fit/find/hand_points.h"
#include "face_fit/fit/fit.h"
#include "fsm/head/face_set.h"
#include "fsm/mesh/head_points.h"
#include "fsm/render/renderer.h"

namespace facefit {
namespace {

constexpr int kSide = 900;
constexpr const char* kPlaces[] = {"exocanthion_right", "exocanthion_left", "endocanthion_right",
                                   "endocanthion_left", "cheilion_right",   "cheilion_left",
                                   "pronasale",         "subnasale",        "alare_right",
                                   "alare_left",        "nasion",           "gnathion"};

class TruthTest : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    auto loaded = FaceNetworks::Load("");
    if (!loaded) GTEST_SKIP() << loaded.error().text;
    networks_.emplace(std::move(*loaded));
    truth_ = fsm::Head::Make(GetParam(), false);
    fsm::HeadVertices vertices;
    truth_->Evaluate({}, vertices);
    const auto context = fsm::RenderContext::MakeHeadless(kSide, kSide);
    const auto renderer = fsm::Renderer::Make(*context);
    renderer->Draw(*truth_, vertices, {}, fsm::Scene{});
    renderer->Read(photo_);
  }
  std::optional<FaceNetworks> networks_;
  std::unique_ptr<fsm::Head> truth_;
  fsm::Image photo_;
};

/// Places of both heads, the fitted one brought over the true one.
std::vector<fsm::PlacePair> Compared(const fsm::Head& truth, const fsm::Head& fitted) {
  std::vector<fsm::PlacePair> pairs;
  for (const char* place : kPlaces) {
    pairs.push_back({truth.Landmark(place), fitted.Landmark(place), fsm::FacePart::kPlain});
  }
  const fsm::Similarity over = fsm::FitSimilarity(pairs);
  for (auto& pair : pairs) pair.to = over(pair.to);
  return pairs;
}

TEST_P(TruthTest, LandmarksAndDepthComeNearTheHeadThatWasDrawn) {
  const auto boxes = FindFaces(*networks_, photo_);
  ASSERT_EQ(boxes.size(), 1U);
  const FoundFace face = FindPoints(*networks_, photo_, boxes[0]);
  const BaseHead base = BaseHead::See(*networks_, "galatea");
  const Fit fit = FitFace(base, face);
  fsm::FaceSet set;
  set.points = fit.points;
  set.smooth = fit.smooth;
  set.photo = std::make_shared<fsm::WornPhoto>(fsm::WornPhoto{1, 1, {0, 0, 0, 255}});
  const auto fitted = fsm::Head::Make(set);
  const auto pairs = Compared(*truth_, *fitted);
  const float eyes = glm::distance(pairs[0].from, pairs[1].from);
  float sum = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const float flat = glm::distance(glm::vec2(pairs[i].from), glm::vec2(pairs[i].to));
    sum += flat / eyes;
    std::printf("%-9s %-20s %4.1f %% of the eyes' distance, depth %+.1f mm\n", GetParam(),
                kPlaces[i], static_cast<double>(100 * flat / eyes),
                static_cast<double>(pairs[i].to.z - pairs[i].from.z));
  }
  std::printf("%-9s mean %.2f %%\n", GetParam(),
              static_cast<double>(100 * sum / static_cast<float>(pairs.size())));
  EXPECT_LT(sum / static_cast<float>(pairs.size()), 0.015F);
  for (const std::size_t i : {6U, 10U, 11U}) {  // nose, between the brows, chin
    EXPECT_LT(std::abs(pairs[i].to.z - pairs[i].from.z), 4) << kPlaces[i];
  }
}

INSTANTIATE_TEST_SUITE_P(OtherFaces, TruthTest, testing::Values("pygmalion", "baucis"));

TEST(HandPointsTest, SixPlacesPutTheFaceWhereTheyAre) {
  auto networks = FaceNetworks::Load("");
  if (!networks) GTEST_SKIP() << networks.error().text;
  const auto points = ParseHandPoints("p",
                                      "# a photo\nright_eye_outer 200 300\nleft_eye_outer 320 300\n"
                                      "nose_tip 262 365\nmouth_right 225 410\nmouth_left 295 410\n"
                                      "chin 260 480\n");
  ASSERT_TRUE(points) << points.error().text;
  const BaseHead base = BaseHead::See(*networks, "galatea");
  const FoundFace face = FaceFromHand(base, *points);
  for (const auto& [i, at] : *points) {
    EXPECT_LT(glm::distance(glm::vec2(face.points[i]), at), 4) << i;
  }
  // What was not said lies between: the forehead above the eyes, the lips between the corners.
  EXPECT_LT(face.points[10].y, 250);
  EXPECT_NEAR(face.points[13].x, 260, 8);
  EXPECT_NEAR(FitFace(base, face).pose.turn.y, 0, 0.2F);
}

TEST(HandPointsTest, AWireframeOfAnotherHeadIsRefused) {
  const auto wireframe = fsm::ParsePnt("w.pnt", "#2\n1 1 33 0 0 0\n");
  ASSERT_TRUE(wireframe);
  const auto points = PointsOfWireframe("w.pnt", *wireframe, 100, 100);
  ASSERT_FALSE(points);
  EXPECT_NE(points.error().text.find("w.pnt: point 14 of group 1"), std::string::npos)
      << points.error().text;
}

TEST(HandPointsTest, DamageIsToldWithItsLine) {
  for (const auto& [text, words] :
       {std::pair("chin 1\n", "p:1: NAME X Y"), std::pair("chin 1 2 3\n", "p:1: NAME X Y"),
        std::pair("\near 1 2\n", "p:2: 'ear' is no point"),
        std::pair("468 1 2\n", "p:1: '468' is no point"), std::pair("chin 1 nan\n", "p:1"),
        std::pair("chin 1 2\n", "right_eye_outer is missing")}) {
    const auto points = ParseHandPoints("p", text);
    ASSERT_FALSE(points) << text;
    EXPECT_NE(points.error().text.find(words), std::string::npos) << points.error().text;
  }
}

}  // namespace
}  // namespace facefit
