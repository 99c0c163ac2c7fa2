#include "face_fit/bake/appearance.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace facefit {
namespace {

std::string Error(const std::string& text) {
  try {
    ReadAppearance("t", text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(AppearanceTest, TheBuiltInTableIsComplete) {
  const Appearance& look = BuiltInAppearance();
  EXPECT_GT(look.fold_reach, 0);
  EXPECT_LT(look.light_gain.x, look.light_gain.y);
}

TEST(AppearanceTest, WhatIsWrongIsSaidWithItsLine) {
  EXPECT_EQ(Error("# a face\nnose 1\n"), "t:2: 'nose' is not known");
  EXPECT_EQ(Error("light_gain 1\n"), "t:1: 'light_gain' needs 2 numbers after it, found 1");
  EXPECT_EQ(Error("lid_shade 1 2\n"), "t:1: 'lid_shade' needs 1 numbers after it, found 2");
  EXPECT_EQ(Error("lid_shade x\n"), "t:1: 'x' found where a number was expected");
  EXPECT_EQ(Error("lid_shade 1\nlid_shade 1\n"), "t:2: 'lid_shade' is there twice");
  EXPECT_EQ(Error("lid_shade -1001\n"), "t:1: a number beyond -1000 to 1000");
  EXPECT_EQ(Error("lid_shade 1\n"), "t: 'facing_least' is missing");
}

TEST(AppearanceTest, ARampRunsEitherWay) {
  EXPECT_EQ(Ramp({1, 3}, 1), 0);
  EXPECT_EQ(Ramp({1, 3}, 2), 0.5F);
  EXPECT_EQ(Ramp({3, 1}, 1), 1);
}

}  // namespace
}  // namespace facefit
