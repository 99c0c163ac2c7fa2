#include "face_fit/find/face/hand_points.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/find/network/face_networks.h"
#include "face_fit/fit/fit.h"
#include "tests/face_fit/grey_image.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {
namespace {

TEST(HandPointsTest, SixPlacesPutTheFaceWhereTheyAre) {
  auto networks = FaceNetworks::Load("");
  if (!networks) GTEST_SKIP() << networks.error().text;
  const auto points = ParseHandPoints("p",
                                      "# a photo\nright_eye_outer 200 300\nleft_eye_outer 320 300\n"
                                      "nose_tip 262 365\nmouth_right 225 410\nmouth_left 295 410\n"
                                      "chin 260 480\n");
  ASSERT_TRUE(points) << points.error().text;
  const ObservedHead base = vm::OrThrow(ObservedHead::BuiltIn(*networks, "galatea"));
  const FoundFace face = FaceFromHand(base, *points);
  for (const auto& [i, at] : *points) {
    EXPECT_LT(glm::distance(glm::vec2(face.points[i]), at), 4) << i;
  }
  // What was not said lies between: the forehead above the eyes, the lips between the corners.
  EXPECT_LT(face.points[10].y, 250);
  EXPECT_NEAR(face.points[13].x, 260, 8);
  EXPECT_NEAR(FitFace(base, face, EvenGreyImage(600)).head.pose.rotation_rad.y, 0, 0.2F);
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

const std::string kFace =
    "right_eye_outer 200 300\nleft_eye_outer 320 300\nnose_tip 262 365\nmouth_right 225 410\n"
    "mouth_left 295 410\nchin 260 480\n";

TEST(HandPointsTest, APointThatIsSetTwiceIsRefused) {
  for (const std::string again : {"chin", "152"}) {  // the same point
    const auto points = ParseHandPoints("p", kFace + again + " 1 2\n");
    ASSERT_FALSE(points) << again;
    EXPECT_EQ(points.error().text, "p:7: '" + again + "' is set a second time");
  }
}

TEST(HandPointsTest, CornersInOnePlaceAreRefused) {
  const std::string rest = "nose_tip 262 365\nchin 260 480\n";
  for (const auto& [corners, words] :
       {std::pair("right_eye_outer 9 9\nleft_eye_outer 9 9\nmouth_right 9 9\nmouth_left 9 9\n",
                  "p: the outer corners of the eyes lie in one place"),
        std::pair("right_eye_outer 200 300\nleft_eye_outer 320 300\nmouth_right 260 410\n"
                  "mouth_left 262 410\n",
                  "p: the corners of the mouth lie in one place")}) {
    const auto points = ParseHandPoints("p", corners + rest);
    ASSERT_FALSE(points) << corners;
    EXPECT_EQ(points.error().text, words);
  }
}

TEST(HandPointsTest, PointsOfWhichNoneLiesInThePhotoAreRefused) {
  const auto points = ParseHandPoints("p", kFace);
  ASSERT_TRUE(points) << points.error().text;
  EXPECT_TRUE(CheckWithin(*points, 640, 480));
  EXPECT_TRUE(CheckWithin(*points, 210, 310)) << "a face that is cut off";
  const auto none = CheckWithin(*points, 160, 120);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().text,
            "none of the points lies in the photo, which is 160 x 120 pixels where points are set");
}

}  // namespace
}  // namespace facefit
