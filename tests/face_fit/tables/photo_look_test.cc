#include "face_fit/tables/photo_look.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace facefit {
namespace {

std::string Error(const std::string& text) {
  try {
    PhotoLookOf("t", text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(PhotoLookTest, TheBuiltInTableIsComplete) {
  const PhotoLookNumbers& look = PhotoLook();
  EXPECT_GT(look.fold_reach, 0);
  EXPECT_LT(look.light_gain.x, look.light_gain.y);
}

TEST(PhotoLookTest, WhatIsWrongIsSaidWithItsLine) {
  EXPECT_EQ(Error("# a face\nnose 1\n"), "t:2: 'nose' is not known");
  EXPECT_EQ(Error("light_gain 1\n"), "t:1: 'light_gain' needs 2 numbers after it, found 1");
  EXPECT_EQ(Error("lid_shade 1 2\n"), "t:1: 'lid_shade' needs 1 numbers after it, found 2");
  EXPECT_EQ(Error("lid_shade 1x\n"), "t:1: '1x' found where a number was expected");
  EXPECT_EQ(Error("lid_shade 1\nlid_shade 1\n"), "t:2: 'lid_shade' is there twice");
  EXPECT_EQ(Error("lid_shade -1001\n"), "t:1: a number beyond -1000 to 1000");
  EXPECT_EQ(Error("lid_shade 1\n"), "") << "other rows are the built-in ones";
}

TEST(PhotoLookTest, ARampRunsEitherWay) {
  EXPECT_EQ(Ramp({1, 3}, 1), 0);
  EXPECT_EQ(Ramp({1, 3}, 2), 0.5F);
  EXPECT_EQ(Ramp({3, 1}, 1), 1);
}

}  // namespace
}  // namespace facefit
