#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <string>

#include "face_editor/core/editor.h"
#include "face_editor/core/face_points.h"
#include "face_fit/find/face/hand_points.h"
#include "fsm/image/image_file.h"

namespace editor {
namespace {

constexpr int kRightEye = 33, kLeftEye = 263, kChin = 152, kRightBrow = 105;

PointMap Face() { return PlainPoints(400, 400); }

Drag Of(std::set<int> points, glm::vec2 by, bool symmetric, float reach = 0) {
  return {std::move(points), by, symmetric, reach};
}

glm::vec2 Moved(const PointMap& from, const PointMap& to, int i) {
  return glm::vec2(to.at(i)) - glm::vec2(from.at(i));
}

TEST(FacePointsTest, APlainFaceHasAllNamedPointsRightOnTheLeft) {
  const PointMap face = Face();
  EXPECT_EQ(face.size(), facefit::NamedPoints().size());
  EXPECT_LT(face.at(kRightEye).x, face.at(kLeftEye).x);
  EXPECT_FLOAT_EQ(face.at(kChin).x, 200);
  EXPECT_GT(face.at(kChin).y, face.at(kRightEye).y);
}

TEST(FacePointsTest, TheOtherSideDoesTheSameMirrored) {
  const PointMap face = Face();
  const PointMap moved = Dragged(face, MirrorByName(), Of({kRightEye}, {5, 3}, true));
  EXPECT_EQ(Moved(face, moved, kRightEye), glm::vec2(5, 3));
  EXPECT_NEAR(Moved(face, moved, kLeftEye).x, -5, 1e-3);
  EXPECT_NEAR(Moved(face, moved, kLeftEye).y, 3, 1e-3);
  EXPECT_EQ(Moved(face, moved, kChin), glm::vec2(0));
}

TEST(FacePointsTest, WithoutSymmetryOnlyOneSideMoves) {
  const PointMap face = Face();
  const PointMap moved = Dragged(face, MirrorByName(), Of({kRightEye}, {5, 3}, false));
  EXPECT_EQ(Moved(face, moved, kLeftEye), glm::vec2(0));
}

TEST(FacePointsTest, OnATiltedFaceTheMirrorIsTilted) {
  PointMap face = Face();
  // A quarter turn: the median runs to the left.
  for (auto& [i, at] : face) at = glm::vec3(200 - (at.y - 200), 200 + (at.x - 200), 0);
  const PointMap moved = Dragged(face, MirrorByName(), Of({kRightEye}, {5, 3}, true));
  EXPECT_NEAR(Moved(face, moved, kLeftEye).x, 5, 1e-3);
  EXPECT_NEAR(Moved(face, moved, kLeftEye).y, -3, 1e-3);
}

TEST(FacePointsTest, AlonePointsOfTheMedianStayOnIt) {
  const PointMap face = Face();
  const PointMap moved = Dragged(face, MirrorByName(), Of({kChin}, {7, 4}, true));
  EXPECT_NEAR(Moved(face, moved, kChin).x, 0, 1e-3);
  EXPECT_NEAR(Moved(face, moved, kChin).y, 4, 1e-3);
}

TEST(FacePointsTest, BothSidesTogetherMoveAsOne) {
  const PointMap face = Face();
  const PointMap moved =
      Dragged(face, MirrorByName(), Of({kRightEye, kLeftEye, kChin}, {7, 4}, true));
  for (const int i : {kRightEye, kLeftEye, kChin})
    EXPECT_EQ(Moved(face, moved, i), glm::vec2(7, 4));
}

TEST(FacePointsTest, WhatIsNearGoesAlongTheLessTheFarther) {
  const PointMap face = Face();
  const PointMap moved = Dragged(face, MirrorByName(), Of({kRightEye}, {0, -10}, false, 100));
  const float brow = -Moved(face, moved, kRightBrow).y;
  EXPECT_GT(brow, 1);
  EXPECT_LT(brow, 10);
  EXPECT_EQ(Moved(face, moved, kChin), glm::vec2(0));
}

TEST(FacePointsTest, MirrorOfPlacesPairsTheSidesAndKeepsTheMedian) {
  const std::vector<glm::vec3> places = {{-30, 10, 5}, {30.5F, 10, 5}, {0.2F, -50, 8}, {12, 3, 1}};
  EXPECT_EQ(MirrorOf(places), (Mirror{1, 0, 2, 3}));
}

TEST(FacePointsTest, WhatIsWrittenIsWhatFaceFitReads) {
  PointMap face = Face();
  face[7] = {12.34F, 56.78F, 9};
  const auto read = facefit::ParseHandPoints("p", WritePoints(face));
  ASSERT_TRUE(read) << read.error().text;
  ASSERT_EQ(read->size(), face.size());
  for (const auto& [i, at] : *read) {
    EXPECT_LT(glm::distance(at, glm::vec2(face.at(static_cast<int>(i)))), 0.01F) << i;
  }
}

TEST(FacePointsTest, PointsOfAnotherPhotoAreNotLaidBesideThisOne) {
  std::string folder = testing::TempDir() + "/points_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  ASSERT_TRUE(fsm::WriteImage(fsm::FilledImage(80, 64), folder + "/small.png"));
  auto editor = *Editor::Make("");
  ASSERT_TRUE(editor->OpenPhoto(folder + "/small.png", 1));
  const std::string path = folder + "/points.txt";
  std::ofstream(path) << WritePoints(PlainPoints(4000, 3000));
  const auto loaded = editor->LoadPoints(path);
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().text,
            path +
                ": none of the points lies in the photo, which is 80 x 64 pixels where points "
                "are set");
  EXPECT_TRUE(editor->state().points == PlainPoints(80, 64)) << "those there were stay";
  std::filesystem::remove_all(folder);
}

TEST(FacePointsTest, UnknownNamesAreRefusedWithThoseThereAre) {
  for (const char* word : {"ear", "468", "", "-1", "chin2"}) {
    const auto points = PointsNamed(word);
    ASSERT_FALSE(points) << word;
    EXPECT_NE(points.error().text.find("mouth_left"), std::string::npos);
  }
  EXPECT_EQ(*PointsNamed("chin"), std::set<int>{kChin});
  EXPECT_EQ(*PointsNamed("467"), std::set<int>{467});
  EXPECT_GT(PointsNamed("mouth")->size(), 30U);
}

}  // namespace
}  // namespace editor
