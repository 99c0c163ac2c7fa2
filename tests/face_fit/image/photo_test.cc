#include "face_fit/image/photo.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdio>
#include <cstdlib>

#include "face_fit/image/filters.h"

// Only after the standard's headers, whose names it uses.
#include <jpeglib.h>

#include "fsm/image/image_codec.h"

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
  const fsm::Image turned = OrientedByExif(image, 6);  // the camera was held turned to the left
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
  const fsm::Image one = ScaledToFit(image, 1);
  EXPECT_EQ(one.rgba[0], 119);
}

TEST(PhotoTest, WhatIsNoImageIsRefusedInWords) {
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
  std::fill_n(&huge[16], 8, std::uint8_t{0xff});  // whose product would be negative
  const auto endless = DecodePhoto(huge);
  ASSERT_FALSE(endless);
  EXPECT_NE(endless.error().text.find("4294967295 x"), std::string::npos) << endless.error().text;
}

/// An image of stripes, so that every part of the file matters.
std::vector<std::uint8_t> Jpeg(JDIMENSION width, JDIMENSION height, J_COLOR_SPACE space,
                               bool adobe = true) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &memory, &size);
  info.image_width = width;
  info.image_height = height;
  info.input_components = space == JCS_CMYK ? 4 : 3;
  info.in_color_space = space;
  jpeg_set_defaults(&info);
  info.write_Adobe_marker = adobe ? TRUE : FALSE;
  jpeg_start_compress(&info, TRUE);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(width) * 4);
  for (JDIMENSION y = 0; y < height; ++y) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = static_cast<std::uint8_t>(space == JCS_CMYK ? (i % 4 == 0 ? 255 : 200)
                                                           : (i * 37 + y * 11) % 256);
    }
    JSAMPROW line = row.data();
    jpeg_write_scanlines(&info, &line, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::vector<std::uint8_t> out(memory, memory + size);
  std::free(memory);
  return out;
}

std::string Refusal(std::span<const std::uint8_t> bytes) {
  const auto read = DecodePhoto(bytes);
  return read ? "" : read.error().text;
}

TEST(PhotoTest, AJpegThatEndsTooEarlyIsRefusedHoweverLittleIsMissing) {
  const auto whole = Jpeg(160, 120, JCS_RGB);
  ASSERT_EQ(Refusal(whole), "");
  for (const std::size_t part : {30U, 60U, 90U, 99U}) {
    const auto refused = Refusal(std::span(whole).first(whole.size() * part / 100));
    EXPECT_NE(refused.find("cut off"), std::string::npos) << part << " %: " << refused;
  }
}

TEST(PhotoTest, AJpegTornInTheMiddleIsRefused) {
  auto torn = Jpeg(160, 120, JCS_RGB);
  const std::size_t middle = torn.size() / 2;
  torn.erase(torn.begin() + static_cast<std::ptrdiff_t>(middle),
             torn.begin() + static_cast<std::ptrdiff_t>(middle + 400));
  torn[middle] = 0xff;
  torn[middle + 1] = 0xd9;  // the end, long before all is there
  EXPECT_NE(Refusal(torn).find("damaged"), std::string::npos) << Refusal(torn);
}

TEST(PhotoTest, AJpegWhoseHeaderSaysHundredMegapixelsIsRefusedBeforeDecoding) {
  auto lies = Jpeg(160, 120, JCS_RGB);
  for (std::size_t i = 0; i + 8 < lies.size(); ++i) {
    if (lies[i] != 0xff || lies[i + 1] != 0xc0) continue;
    lies[i + 5] = lies[i + 7] = 0x27;  // 10000 x 10000
    lies[i + 6] = lies[i + 8] = 0x10;
    break;
  }
  EXPECT_NE(Refusal(lies).find("10000 x 10000"), std::string::npos) << Refusal(lies);
}

TEST(PhotoTest, APngThatReallyHasHundredMegapixelsIsRefused) {
  // One bit a pixel, all black: twelve megabytes in twelve kilobytes.
  const std::vector<std::uint8_t> raw(std::size_t{10000} * 1251, 0);
  uLongf size = compressBound(raw.size());
  std::vector<std::uint8_t> data(size);
  ASSERT_EQ(compress2(data.data(), &size, raw.data(), raw.size(), 9), Z_OK);
  data.resize(size);
  std::vector<std::uint8_t> png = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
  const auto number = [&png](std::size_t n) {
    for (int shift = 24; shift >= 0; shift -= 8) {
      png.push_back(static_cast<std::uint8_t>(n >> shift));
    }
  };
  const auto chunk = [&](const char* name, const std::vector<std::uint8_t>& body) {
    number(body.size());
    const std::size_t begin = png.size();
    png.insert(png.end(), name, name + 4);
    png.insert(png.end(), body.begin(), body.end());
    number(crc32(0, &png[begin], static_cast<uInt>(png.size() - begin)));
  };
  chunk("IHDR", {0, 0, 0x27, 0x10, 0, 0, 0x27, 0x10, 1, 0, 0, 0, 0});
  chunk("IDAT", data);
  chunk("IEND", {});
  EXPECT_NE(Refusal(png).find("10000 x 10000"), std::string::npos) << Refusal(png);
}

TEST(PhotoTest, InksAreReadInvertedOnlyWhereAdobeWroteThem) {
  // Cyan 255, magenta, yellow and black 200.
  const auto adobe = DecodePhoto(Jpeg(80, 80, JCS_CMYK));
  ASSERT_TRUE(adobe) << adobe.error().text;
  EXPECT_GT(adobe->rgba[0], adobe->rgba[1] + 20);
  const auto plain = DecodePhoto(Jpeg(80, 80, JCS_CMYK, false));
  ASSERT_TRUE(plain) << plain.error().text;
  EXPECT_LT(plain->rgba[0], plain->rgba[1] + 1);
  EXPECT_LT(plain->rgba[1], 40);
}

}  // namespace
}  // namespace facefit
