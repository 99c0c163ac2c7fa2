// Recordings as people have them, good and bad.

#include "face_space/record/track.h"

#include <gtest/gtest.h>

#include "face_space/record/recording.h"
#include "face_space/record/unit_track.h"

namespace facespace {
namespace {

std::string ErrorOf(const std::string& text, const TrackFormat& format = {}) {
  const auto track = ParseTrack("take.csv", text, format);
  return track ? "" : track.error().text;
}

/// Eight markers a .. h by names like a_x, and frames of them.
std::string Markers(int frames, const std::string& time = "ms") {
  std::string text = time;
  for (char m = 'a'; m <= 'h'; ++m) {
    for (const char axis : {'x', 'y', 'z'}) text += std::string(",") + m + "_" + axis;
  }
  for (int t = 0; t < frames; ++t) {
    text += "\n" + std::to_string(10 * t);
    for (int k = 0; k < 24; ++k) text += "," + std::to_string(100 * t + k);
  }
  return text + "\n";
}

TEST(TrackTest, MarkersAndTimesAreRead) {
  const auto track = ParseTrack("take.csv", Markers(3));
  ASSERT_TRUE(track) << track.error().text;
  EXPECT_EQ(track->ms, (std::vector<double>{0, 10, 20}));
  ASSERT_TRUE(HasMarkers(*track));
  const auto recording = MarkersOf(*track, 10);
  ASSERT_TRUE(recording) << recording.error().text;
  EXPECT_EQ(recording->markers.size(), 8U);
  EXPECT_EQ(recording->markers[1], "b");
  EXPECT_EQ(recording->places(5, 2), 10 * 205) << "b_z of the third frame, in millimetres";
}

TEST(TrackTest, TimesInSecondsSemicolonsAndWordsAreUnderstood) {
  const auto track =
      ParseTrack("take.csv", "Timecode;t;JawOpen\r\n00:01;0.5;0.1\r\n00:02;0.75;0.2\r\n");
  ASSERT_TRUE(track) << track.error().text;
  EXPECT_EQ(track->ms, (std::vector<double>{500, 750}));
  EXPECT_EQ(track->columns, std::vector<std::string>{"JawOpen"});
}

TEST(TrackTest, WithoutTimesTheRateIsAsked) {
  EXPECT_NE(ErrorOf("au12L\n0\n1\n").find("--rate"), std::string::npos);
  const auto track = ParseTrack("take.csv", "au12L\n0\n1\n", {.rate = 50});
  ASSERT_TRUE(track) << track.error().text;
  EXPECT_EQ(track->ms[1], 20);
}

TEST(TrackTest, FramesWithoutAFaceAreLeftOut) {
  const auto track = ParseTrack("t", "ms,person,au12L\n0,1,0\n10,0,\n20,1,0.5\n");
  ASSERT_TRUE(track) << track.error().text;
  EXPECT_EQ(track->ms, (std::vector<double>{0, 20}));
}

TEST(TrackTest, PointsOfFaceTracksJsonAreMarkers) {
  std::string line = "{\"ms\":%,\"person\":1,\"points\":[[1,2,3]";
  for (int i = 1; i < 9; ++i) line += ",[4,5,6]";
  line += "]}\n";
  std::string text;
  for (const char* ms : {"0", "40"}) text += std::string(line).replace(6, 1, ms);
  text += "{\"ms\":80,\"person\":0}\n";
  const auto track = ParseTrack("take.jsonl", text);
  ASSERT_TRUE(track) << track.error().text;
  const auto recording = MarkersOf(*track);
  ASSERT_TRUE(recording) << recording.error().text;
  EXPECT_EQ(recording->markers[0], "0");
  EXPECT_EQ(recording->places(2, 1), 3);
  EXPECT_EQ(recording->frames(), 2);
}

TEST(TrackTest, BadRecordingsAreRefusedWithTheirPlace) {
  EXPECT_EQ(ErrorOf("ms,a_x\n0,1\n10,1,2\n"), "take.csv:3: 3 columns found, 2 expected");
  EXPECT_EQ(ErrorOf("ms,a_x\n0,1\n10,nan\n"),
            "take.csv:3: column 'a_x': 'nan' found, a number expected");
  EXPECT_EQ(ErrorOf("ms,a_x\n0,1\n10,\n"), "take.csv:3: column 'a_x': '' found, a number expected");
  EXPECT_EQ(ErrorOf("ms,a_x\n0,1\n"), "take.csv: 1 frames found, at least 2 expected");
  EXPECT_EQ(ErrorOf(""), "take.csv: 0 frames found, at least 2 expected");
  EXPECT_EQ(ErrorOf("ms,a_x\n0,1\n0,2\n"),
            "take.csv:3: time 0 ms found after 0 ms; rising times expected");
  EXPECT_EQ(ErrorOf("ms,a,a\n0,1,2\n"), "take.csv:1: column 'a' is there twice");
  EXPECT_EQ(ErrorOf("{\"ms\":0}\n[1]\n"), "take.csv:2: a JSON object expected");
  EXPECT_NE(ErrorOf("{\"ms\":0,\"a\":1}\n{\"ms\":1}\n"), "");
}

TEST(TrackTest, RecordingsThatDoNotBelongTogetherAreRefused) {
  const auto first = MarkersOf(*ParseTrack("one.csv", Markers(2)));
  ASSERT_TRUE(first);
  std::string text = Markers(2);
  text.replace(text.find("h_x"), 3, "q_x");
  auto torn = MarkersOf(*ParseTrack("two.csv", text));
  ASSERT_FALSE(torn);
  EXPECT_NE(torn.error().text.find("has no column of its"), std::string::npos) << torn.error().text;
  for (const char* name : {"h_y", "h_z"}) text.replace(text.find(name), 1, "q");
  auto other = MarkersOf(*ParseTrack("two.csv", text));
  ASSERT_TRUE(other) << other.error().text;
  const auto ordered = OrderAs(*first, *other);
  ASSERT_FALSE(ordered);
  EXPECT_EQ(ordered.error().text, "two.csv: there is no marker 'h', which one.csv has");
  EXPECT_FALSE(MarkersOf(*ParseTrack("few.csv", "ms,a_x,a_y,a_z\n0,1,2,3\n1,1,2,3\n")))
      << "of one marker the head's motion cannot be told";
}

TEST(TrackTest, UnitsAndShapesOfArkitBecomeLooks) {
  const auto tables = fsm::MotionTables::Load();
  ASSERT_TRUE(tables);
  const auto track =
      ParseTrack("t", "ms,au12L,jawOpen,MouthSmileRight,blah\n0,0,0,0,1\n9,0.5,1,9,1\n");
  ASSERT_TRUE(track) << track.error().text;
  const auto units = UnitsOf(*track, *tables);
  ASSERT_TRUE(units) << units.error().text;
  const auto& look = units->looks[1];
  EXPECT_FLOAT_EQ(look.au.left[12], 0.5F);
  EXPECT_FLOAT_EQ(look.au.right[12], 2) << "strengths end at 2";
  EXPECT_GT(look.au.left[26] + look.au.left[27], 0);
  EXPECT_FALSE(UnitsOf(*ParseTrack("t", "ms,blah\n0,1\n1,1\n"), *tables));
}

}  // namespace
}  // namespace facespace
