#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "film_dub/follow/film_course.h"
#include "film_dub/follow/grain.h"
#include "film_dub/timing/dub_timing.h"

namespace filmdub {
namespace {

std::vector<double> Times(std::size_t pictures, double step_ms) {
  std::vector<double> times;
  for (std::size_t i = 0; i < pictures; ++i) times.push_back(step_ms * static_cast<double>(i));
  return times;
}

TEST(DubTimingTest, TheRateIsTheUsualOneThoughSomePicturesAreMissing) {
  auto times = Times(100, 1001.0 / 30);
  EXPECT_NEAR(PicturesPerSecond(times), 30000.0 / 1001, 1e-6);
  times.erase(times.begin() + 40, times.begin() + 45);
  EXPECT_NEAR(PicturesPerSecond(times), 30000.0 / 1001, 1e-6);
}

TEST(DubTimingTest, AFilmAsLongAsItsSoundIsShownAsItIs) {
  const auto shown = FitLength(Times(50, 40), 25, 2.0);
  ASSERT_TRUE(shown);
  ASSERT_EQ(shown->size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ((*shown)[i], i);
}

TEST(DubTimingTest, PicturesAreHeldOrDroppedEvenly) {
  const auto longer = FitLength(Times(50, 40), 25, 3.0),
             shorter = FitLength(Times(50, 40), 25, 1.0);
  ASSERT_TRUE(longer && shorter);
  EXPECT_EQ(longer->size(), 75U);
  EXPECT_EQ(std::set(longer->begin(), longer->end()).size(), 50U) << "none is left out";
  EXPECT_EQ(shorter->size(), 25U);
  for (std::size_t i = 1; i < shorter->size(); ++i) EXPECT_EQ((*shorter)[i], (*shorter)[i - 1] + 2);
}

TEST(DubTimingTest, WhatWouldBeStretchedTooFarIsRefusedWithBothLengths) {
  const auto shown = FitLength(Times(50, 40), 25, 4.5);
  ASSERT_FALSE(shown);
  EXPECT_NE(shown.error().text.find("lasts 2.00 s and its new sound 4.50"), std::string::npos)
      << shown.error().text;
}

TEST(FilmCourseTest, StretchesAreToldByTheirTimes) {
  FilmCourse course;
  for (int i = 0; i < 10; ++i)
    course.lines.push_back({.ms = 100.0 * i, .units = {}, .points = {}, .places = {}});
  EXPECT_EQ(Stretches(course, [](std::size_t i) { return i == 0 || (i > 3 && i < 7); }),
            "0.00 s, 0.40 to 0.60 s");
  EXPECT_EQ(Stretches(course, [](std::size_t) { return false; }), "");
}

TEST(GrainTest, IsTheNoiseOfWhatStandsStill) {
  std::mt19937 dice(1);
  std::normal_distribution<double> noise(0, 5);
  const auto picture = [&](bool noisy, int moved) {
    fsm::Image image = fsm::FilledImage(160, 128);
    for (int y = 0; y < 128; ++y) {
      for (int x = 0; x < 160; ++x) {
        const double value =
            (x < 40 ? 100 + 50 * ((x + moved) % 7 / 6.0) : 120) + (noisy ? noise(dice) : 0);
        for (std::size_t c = 0; c < 3; ++c) {
          image.rgba[4 * image.Index(x, y) + c] = static_cast<std::uint8_t>(std::lround(value));
        }
      }
    }
    return image;
  };
  const facefit::Box2 all{.low = {-5, 0}, .high = {200, 128}};
  EXPECT_NEAR(GrainBetween(picture(true, 0), picture(true, 3), all), 5.0 / 255, 1.0 / 255);
  EXPECT_EQ(GrainBetween(picture(false, 0), picture(false, 3), all), 0);
  EXPECT_EQ(GrainBetween(picture(true, 0), picture(true, 3), {}), 0) << "no part";
}

TEST(FilmCourseTest, TheRestIsAFaceTurnedToTheCameraWithItsMouthShut) {
  FilmCourse course;
  const auto add = [&](float right, float jaw, float lid, int person) {
    facetrack::FaceLine line;
    line.person = person;
    line.certainty = 1;
    line.head = {0, right, 0};
    line.jaw = jaw;
    line.lid = {lid, lid};
    course.lines.push_back(line);
  };
  add(0, 0, 1, 0);   // nobody
  add(0, 0, 0, 1);   // shut eyes
  add(2, 8, 1, 1);   // speaks
  add(3, 0, 1, 1);   // the one
  add(40, 0, 1, 1);  // turned away
  EXPECT_EQ(course.RestPicture(), 3U);
  EXPECT_FALSE(course.IsUsable(0));
  EXPECT_FALSE(course.IsUsable(4));
}

TEST(FilmCourseTest, AHeadTurnsOnFromWhereItIsHeld) {
  FilmCourse course;
  course.lines.resize(2);
  course.lines[0].head = {1, 2, 3};
  course.lines[1].head = {5, -10, 3};
  EXPECT_EQ(course.Turned({0.5F, 1, -1}, 0, 1), (fsm::Angles{4.5F, -11, -1}));
}

}  // namespace
}  // namespace filmdub
