// The files of masks and calibrations: what is read, and what is said of those that are wrong.

#include <gtest/gtest.h>

#include <string>

#include "hypermask/base/mask_layout.h"
#include "hypermask/project/calibration.h"

namespace hypermask {
namespace {

const std::string kGood =
    "hypermask calibration 1\n"
    "camera 640 480 810 319.5 239.5  # a note\n"
    "\n"
    "projector 1280 720\r\n"
    "homography 2 0 10 0 2 20 0 0 1\n"
    "affine 2 0 10 0 2 20\n"
    "space 1500 0 640 10 0 1500 360 20 0 0 1 0\n"
    "rms 0.5 0.75 0.25\n";

std::string ErrorOf(const std::string& text) {
  const auto read = ParseCalibration("room.txt", text);
  return read ? "" : read.error().text;
}

/// kGood with one line, told by its key, put otherwise.
std::string With(const std::string& key, const std::string& line) {
  std::string text = kGood;
  const auto at = text.find("\n" + key) + 1;
  return text.replace(at, text.find('\n', at) - at, line);
}

TEST(CalibrationTest, WhatIsWrittenIsReadAgain) {
  auto read = ParseCalibration("room.txt", kGood);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_FALSE(read->delay_ms);
  read->delay_ms = 83;
  read->homography(2, 0) = 1.0 / 3e5;
  const auto again = ParseCalibration("again", FormatCalibration(*read));
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_EQ(again->camera.width, 640);
  EXPECT_EQ(again->camera.focal, 810);
  EXPECT_EQ(again->projector_height, 720);
  EXPECT_LT((again->homography - read->homography).norm(), 1e-9);
  EXPECT_LT((again->affine - read->affine).norm(), 1e-9);
  EXPECT_LT((again->space - read->space).norm(), 1e-9);
  EXPECT_EQ(again->affine_rms, 0.75);
  EXPECT_EQ(again->delay_ms, 83);
}

TEST(CalibrationTest, WhatIsWrongIsNamedWithItsLine) {
  EXPECT_EQ(ErrorOf(""),
            "room.txt:1: the file is empty, expected the heading 'hypermask calibration 1'");
  EXPECT_EQ(ErrorOf("P5 640 480\n"),
            "room.txt:1: found 'P5 640 480', expected the heading 'hypermask calibration 1'");
  EXPECT_EQ(ErrorOf(With("camera", "camera 640 480")),
            "room.txt:2: 2 numbers follow 'camera', expected 5");
  EXPECT_EQ(ErrorOf(With("camera", "camera 640 480 many 319 239")),
            "room.txt:2: found 'many', expected a number within +-1e9");
  EXPECT_EQ(ErrorOf(With("camera", "camera 640 480 nan 319 239")),
            "room.txt:2: found 'nan', expected a number within +-1e9");
  EXPECT_EQ(ErrorOf(With("camera", "camera 640 480 1e300 319 239")),
            "room.txt:2: found '1e300', expected a number within +-1e9");
  EXPECT_EQ(ErrorOf(With("camera", "camera 640.5 480 810 319 239")),
            "room.txt:2: 'camera': expected whole numbers of 16 to 8192 pixels");
  EXPECT_EQ(ErrorOf(With("camera", "camera 640 480 0 319 239")),
            "room.txt:2: 'camera': expected a focal length of 0.1 to 100 times the picture's "
            "longer side");
  EXPECT_EQ(ErrorOf(With("projector", "projector 0 720")),
            "room.txt:4: 'projector': expected whole numbers of 16 to 8192 pixels");
  EXPECT_EQ(ErrorOf(With("homography", "homography 1 2 3 2 4 6 0 0 1")),
            "room.txt:5: 'homography': its rows do not make a map that can be reversed");
  EXPECT_EQ(ErrorOf(With("affine", "affine 0 0 1 0 0 1")),
            "room.txt:6: 'affine': its rows do not make a map that can be reversed");
  EXPECT_EQ(ErrorOf(With("space", "space 0 0 0 0 0 0 0 0 0 0 0 0")),
            "room.txt:7: 'space': its rows do not make a projector");
  EXPECT_EQ(ErrorOf(With("rms", "rms 1 -1 1")), "room.txt:8: 'rms': expected no negative number");
  EXPECT_EQ(ErrorOf(kGood + "delay 5000\n"), "room.txt:9: 'delay': expected 0 to 1000 ms");
  EXPECT_EQ(ErrorOf(kGood + "rms 1 1 1\n"), "room.txt:9: one 'rms' too many, expected at most 1");
  EXPECT_EQ(ErrorOf(kGood + "focus\x01 1\n"),
            "room.txt:9: found 'focus?', expected one of: affine, camera, delay, homography, "
            "projector, rms, space");
  EXPECT_EQ(ErrorOf(With("space", "")),
            "room.txt:8: the file ends with 0 lines 'space', expected at least 1");
}

TEST(CalibrationTest, AFileThatIsNotThereIsNamed) {
  const auto read = ReadCalibration("/nothing/here.txt");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().text.find("/nothing/here.txt"), std::string::npos);
}

std::string MaskErrorOf(const std::string& lines) {
  const auto read = ParseMaskLayout("m.txt", "hypermask mask 1\n" + lines);
  return read ? "" : read.error().text;
}

TEST(MaskLayoutTest, TheBuiltInOneHasFiveMarkers) {
  EXPECT_EQ(MaskLayout::Default().markers.size(), 5U);
}

TEST(MaskLayoutTest, WhatIsWrongIsNamedWithItsLine) {
  const std::string corners =
      "marker -1e2 -100\nmarker 100 -100\nmarker 100 100\nmarker -100 100\n";
  const std::string rest = "oval 90 120\npicture 0 0 300\n";
  EXPECT_EQ(MaskErrorOf(corners + rest), "");
  EXPECT_EQ(MaskErrorOf("marker 0 0\nmarker 50 0\n" + rest),
            "m.txt:5: the file ends with 2 lines 'marker', expected at least 4");
  EXPECT_EQ(MaskErrorOf("marker 0 0\nmarker 3 4\n" + rest),
            "m.txt:3: 'marker': (3, 4) lies within 10 mm of another marker");
  EXPECT_EQ(MaskErrorOf("marker 0 0\nmarker 0 3000\n" + rest),
            "m.txt:3: 'marker': (0, 3000) is farther than 2000 mm");
  EXPECT_EQ(MaskErrorOf("marker 0 0\nmarker 0 100\nmarker 100 100\nmarker 100 0\n" + rest),
            "m.txt:5: 'marker': the first four are not the corners of a convex figure, clockwise");
  EXPECT_EQ(MaskErrorOf(corners + "oval 0 120\npicture 0 0 300\n"),
            "m.txt:6: 'oval': expected lengths of 1 to 4000 mm");
}

}  // namespace
}  // namespace hypermask
