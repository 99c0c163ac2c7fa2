#include "face_fit/side/side_photo.h"

#include <gtest/gtest.h>

namespace facefit {
namespace {

TEST(SidePhotoTest, SoManyAreUsedAndNoMore) {
  EXPECT_TRUE(CheckSidePhotoCount(kMaxSidePhotos));
  const auto more = CheckSidePhotoCount(kMaxSidePhotos + 1);
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, vm::Errc::kLimit);
}

}  // namespace
}  // namespace facefit
