#include "face_fit/find/face/upright.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "face_fit/image/filters.h"
#include "face_fit/image/photo.h"
#include "tests/face_fit/group_photo.h"
#include "tests/face_fit/network_fixture.h"
#include "tests/support/test_data.h"

namespace facefit {
namespace {

using UprightTest = NetworkTest;

TEST_F(UprightTest, APhotoThatLiesIsSetUpright) {
  const auto photos = support::Photos();
  if (!photos.Has("collins_nasa.png")) GTEST_SKIP() << photos.Missing();
  const std::string path = photos / "collins_nasa.png";
  const auto photo = ReadPhoto(path);
  ASSERT_TRUE(photo) << photo.error().text;
  for (const auto& [lying, upright] : {std::pair(1, 1), {6, 8}, {8, 6}, {3, 3}}) {
    const UprightPhoto found = SetUpright(*networks_, OrientedByExif(*photo, lying));
    EXPECT_EQ(found.orientation, upright) << lying;
    EXPECT_EQ(found.image.rgba, photo->rgba) << lying;
    ASSERT_EQ(found.faces.size(), 1U) << lying;
    EXPECT_LT(found.faces[0].PixelOf(point::kForehead).y, found.faces[0].PixelOf(point::kChin).y)
        << lying;
  }
}

TEST_F(UprightTest, AGroupWhoseLargestFaceLeansToOneSideStaysAsItIs) {
  const fsm::Image photo = GroupPhoto(1600, 1000,
                                      {{"galatea", 0, 58, 600, 300, 500},
                                       {"pygmalion", 10, 0, 100, 200, 380},
                                       {"baucis", -10, -5, 1150, 200, 380}});
  EXPECT_EQ(SetUpright(*networks_, photo).orientation, 1);
  EXPECT_EQ(SetUpright(*networks_, OrientedByExif(photo, 6)).orientation, 8);
}

}  // namespace
}  // namespace facefit
