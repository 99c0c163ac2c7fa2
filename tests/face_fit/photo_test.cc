#include "face_fit/picture/photo.h"

#include <gtest/gtest.h>

#include "fsm/render/image_codec.h"

namespace facefit {
namespace {

std::vector<std::uint8_t> Exif(bool little, int orientation) {
  const auto o = static_cast<std::uint8_t>(orientation);
  if (little) {
    return {'E',  'x', 'i', 'f', 0, 0, 'I', 'I', 42, 0, 8, 0, 0, 0, 1, 0,
            0x12, 1,   3,   0,   1, 0, 0,   0,   o,  0, 0, 0, 0, 0, 0, 0};
  }
  return {'E', 'x',  'i', 'f', 0, 0, 'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1,
          1,   0x12, 0,   3,   0, 0, 0,   1,   0, o,  0, 0, 0, 0, 0, 0};
}

TEST(ExifTest, OrientationIsReadInBothByteOrders) {
  EXPECT_EQ(ExifOrientation(Exif(true, 6)), 6);
  EXPECT_EQ(ExifOrientation(Exif(false, 3)), 3);
}

TEST(ExifTest, DamagedBlocksSayUpright) {
  EXPECT_EQ(ExifOrientation({}), 1);
  EXPECT_EQ(ExifOrientation(Exif(true, 9)), 1);
  const auto whole = Exif(false, 8);
  for (std::size_t n = 0; n + 8 < whole.size(); ++n) {
    EXPECT_EQ(ExifOrientation(std::span(whole).first(n)), 1) << n;
  }
}

TEST(PhotoTest, TurningBySixPutsTheLeftColumnOnTop) {
  fsm::Image image{.width = 2, .height = 3, .rgba = {}};
  for (std::uint8_t i = 0; i < 6; ++i) image.rgba.insert(image.rgba.end(), {i, i, i, 255});
  const fsm::Image turned = Turned(image, 6);  // the camera was held turned to the left
  ASSERT_EQ(turned.width, 3);
  const std::uint8_t expected[] = {4, 2, 0, 5, 3, 1};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(turned.rgba[4 * i], expected[i]) << i;
}

TEST(PhotoTest, ScalingDownKeepsTheMean) {
  fsm::Image image{.width = 7, .height = 5, .rgba = {}};
  for (int i = 0; i < 35; ++i) {
    const auto v = static_cast<std::uint8_t>(i * 7);
    image.rgba.insert(image.rgba.end(), {v, v, v, 255});
  }
  const fsm::Image one = ScaledDown(image, 1, 1);
  EXPECT_EQ(one.rgba[0], 119);
}

TEST(PhotoTest, WhatIsNoPictureIsRefusedInWords) {
  const std::vector<std::uint8_t> text = {'h', 'e', 'l', 'l', 'o'};
  const auto refused = DecodePhoto(text);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("JPEG or PNG"), std::string::npos);
  const std::vector<std::uint8_t> broken = {0xff, 0xd8, 0xff, 0xe0, 0, 16};
  EXPECT_FALSE(DecodePhoto(broken));
}

TEST(PhotoTest, TooSmallAndTooLargeAreRefusedBeforeDecoding) {
  const auto tiny = DecodePhoto(fsm::EncodePng({.width = 1, .height = 1, .rgba = {1, 2, 3, 255}}));
  ASSERT_FALSE(tiny);
  EXPECT_NE(tiny.error().text.find("1 x 1"), std::string::npos);
  auto huge = fsm::EncodePng({.width = 1, .height = 1, .rgba = {1, 2, 3, 255}});
  huge[18] = huge[22] = 0x27;  // 10000 x 10000 by its header
  huge[19] = huge[23] = 0x10;
  const auto refused = DecodePhoto(huge);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("10000 x 10000"), std::string::npos);
}

}  // namespace
}  // namespace facefit
