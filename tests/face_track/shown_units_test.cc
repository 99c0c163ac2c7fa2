// A person who shows units first is followed as that person moves.

#include "face_track/model/shown_units.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "face_track/fit/frame_fit.h"
#include "face_track/follow/unit_lesson.h"

namespace facetrack {
namespace {

const SeenFace& Usual() { return SeenFace::Shipped(); }

/// What a face does that goes `part` of the usual way, and 1 mm up with the points of one side.
ShownUnit Own(int unit, float part, float one_side_up = 0) {
  ShownUnit shown{.unit = unit, .moved = UsualMotion(Usual(), unit, 1)};
  for (std::size_t i = 0; i < kPoints; ++i) {
    shown.moved[i] *= part;
    if (Usual().rest[i].x > 10) shown.moved[i].y += one_side_up;
  }
  return shown;
}

float Largest(const std::vector<glm::vec2>& a, const std::vector<glm::vec2>& b) {
  float largest = 0;
  for (std::size_t i = 0; i < kPoints; ++i) largest = std::max(largest, glm::length(a[i] - b[i]));
  return largest;
}

TEST(ShownUnitsTest, AFaceMovesAsItWasSeenToAndByLessAtOtherDoses) {
  const std::vector<ShownUnit> shown{Own(12, 0.6F, 1), Own(26, 1.3F)};
  const SeenFace own = FaceOfPerson(Usual(), shown);
  EXPECT_LT(Largest(UsualMotion(own, 12, 1), shown[0].moved), 1e-3);
  EXPECT_LT(Largest(UsualMotion(own, 26, 1), shown[1].moved), 1e-3);
  EXPECT_LT(Largest(UsualMotion(own, 4, 1), UsualMotion(Usual(), 4, 1)), 1e-6) << "not shown";
  // At less it is nearer to what is usual, which goes 1 of the way.
  const auto part = [](float dose) {
    const auto less = UsualMotion(FaceOfPerson(Usual(), std::vector{Own(12, 0.6F)}), 12, dose);
    const auto usual = UsualMotion(Usual(), 12, dose);
    float along = 0, squares = 0;
    for (std::size_t i = 0; i < kPoints; ++i) {
      along += glm::dot(less[i], usual[i]);
      squares += glm::dot(usual[i], usual[i]);
    }
    return along / squares;
  };
  EXPECT_NEAR(part(1), 0.6F, 1e-3);
  EXPECT_GT(part(0.67F), 0.62F);
  EXPECT_GT(part(0.33F), part(0.67F) + 0.02F);
  EXPECT_LT(part(0.33F), 0.9F);
}

TEST(ShownUnitsTest, WhatOneSideDoesBelongsToItsChannel) {
  const SeenFace own = FaceOfPerson(Usual(), std::vector{Own(12, 1, 1)});
  const auto& left = own.channels[own.Find("12L")];
  const auto& right = own.channels[own.Find("12R")];
  for (std::size_t i = 0; i < kPoints; ++i) {
    if (own.rest[i].x < 10) continue;
    EXPECT_NEAR(left.At(i, 1).y - Usual().channels[own.Find("12L")].At(i, 1).y, 1, 1e-3);
    EXPECT_NEAR(right.At(i, 1).y, Usual().channels[own.Find("12R")].At(i, 1).y, 1e-3);
  }
}

TEST(ShownUnitsTest, AFaceThatMovesLessIsToldItsDoseOnceItHasShownIt) {
  const std::vector<ShownUnit> shown{Own(12, 0.6F), Own(4, 0.6F)};
  const SeenFace own = FaceOfPerson(Usual(), shown);
  const Lens lens = Lens::Of(640, 480, 25);
  const Pose pose{.turn = glm::mat3(1), .place = {0, 0, -600}};
  std::vector<float> told(own.channels.size(), 0.0F);
  for (const char* name : {"12L", "12R"}) told[own.Find(name)] = 0.7F;
  std::vector<glm::vec2> places;
  const Points moved = Moved(own, own.rest, told);
  for (std::size_t i = 0; i < kPoints; ++i) places.push_back(SeenAt(own, lens, pose, i, moved[i]));
  const auto found = [&](const SeenFace& face) {
    const FrameFit fit(face, lens);
    Doing start{.pose = pose, .doses = std::vector<float>(face.channels.size(), 0.0F)};
    return fit.Solve(face.rest, places, start, FrameFit::What::kDoses).doses[face.Find("12L")];
  };
  EXPECT_NEAR(found(own), 0.7F, 0.07F);
  EXPECT_LT(found(Usual()), 0.6F);
}

TEST(ShownUnitsTest, ATableIsReadAsItIsPrintedAndDamageIsNamed) {
  const std::string text = PrintShownUnits(std::vector{Own(12, 0.6F), Own(43, 0.5F)});
  const auto again = ParseShownUnits("me.units", text, Usual());
  ASSERT_TRUE(again) << again.error().text;
  EXPECT_EQ(PrintShownUnits(*again), text);
  const auto error = [](const std::string& damaged) {
    const auto parsed = ParseShownUnits("me.units", damaged, Usual());
    return parsed ? std::string("none") : parsed.error().text;
  };
  EXPECT_EQ(error("shown 12 1 0 0\n"), "me.units:1: 2 numbers found, 940 expected");
  EXPECT_EQ(error("shown 99 1 0 0\n"), "me.units:1: unit 99 is none that is followed");
  EXPECT_NE(error("shown 12 7 0 0\n").find("me.units:1: '7' found"), std::string::npos);
  EXPECT_EQ(error("rest 1\n"), "me.units:1: expected 'shown'");
  EXPECT_EQ(error(text + text.substr(text.find("shown 12"))), "me.units:7: 12 is told twice");
  std::string far = text;
  far.replace(far.find("shown 12 1 ") + 11, 1, "99999");
  EXPECT_EQ(error(far), "me.units:5: point 0 moves by more than 100 mm");
}

/// A track of a face at rest, or whose points are moved, or of none (person 0).
class Showing {
 public:
  explicit Showing(const std::string& prompts)
      : lesson_(UnitLesson::Parse("p.txt", prompts, Usual())) {}
  /// 20 lines a second.
  void For(double seconds, const std::vector<glm::vec2>* moved, int person = 1) {
    for (int k = 0; k < 20 * seconds; ++k, ms_ += 50) {
      FaceLine line;
      line.ms = ms_;
      line.person = person;
      if (person != 0) line.points = Usual().rest;
      for (std::size_t i = 0; moved != nullptr && i < kPoints; ++i)
        line.points[i] += glm::vec3((*moved)[i], 0);
      lesson_->Add(line);
    }
  }
  vm::Result<UnitLesson::Learned> Finish() { return lesson_->Finish(); }

 private:
  vm::Result<UnitLesson> lesson_;
  double ms_ = 0;
};

TEST(UnitLessonTest, TheHalfThatMovesMostTellsWhatAUnitDoes) {
  const ShownUnit smile = Own(12, 0.7F), brows = Own(4, 0.1F), jaw = Own(26, 1.1F);
  Showing showing("show 1 3 12\nshow 4 6 4 # hardly\nshow 7 8 26 0.8\n");
  showing.For(1.8, nullptr);
  showing.For(1.5, &smile.moved);  // late, and on beyond the end
  showing.For(1, nullptr);
  showing.For(2, &brows.moved);
  showing.For(0.6, nullptr);
  showing.For(2, &jaw.moved);
  const auto learned = showing.Finish();
  ASSERT_TRUE(learned) << learned.error().text;
  ASSERT_EQ(learned->shown.size(), 2U);
  EXPECT_EQ(learned->shown[0].unit, 12);
  EXPECT_LT(Largest(learned->shown[0].moved, smile.moved), 1e-3);
  EXPECT_EQ(learned->shown[1].dose, 0.8F);
  EXPECT_LT(Largest(learned->shown[1].moved, jaw.moved), 1e-3);
  EXPECT_EQ(learned->left_out,
            std::vector<std::string>{"p.txt: unit 4 from 4 s to 6 s: the points go 10 % of the "
                                     "usual way; the unit is left as it usually is"});
}

TEST(UnitLessonTest, AFilmThatDoesNotShowTheUnitsIsNamed) {
  const auto said = [](double rest, double then, int person) {
    Showing showing("show 1 2 12\nshow 3 4 4\n");
    showing.For(rest, nullptr);
    showing.For(then, nullptr, person);
    const auto learned = showing.Finish();
    if (!learned) return learned.error().text;
    return learned->left_out.empty() ? std::string("none") : learned->left_out.back();
  };
  EXPECT_EQ(said(0.5, 0, 1),
            "p.txt: unit 4 from 3 s to 4 s: no face is seen; the unit is left as it usually is");
  EXPECT_EQ(said(2.5, 2, 0),
            "p.txt: unit 4 from 3 s to 4 s: no face is seen; the unit is left as it usually is");
  EXPECT_EQ(said(0, 5, 0), "no face is seen before the first unit is shown");
  EXPECT_EQ(said(1.5, 5, 2), "another face from 1.5 s on");
}

TEST(UnitLessonTest, PromptsOutOfOrderAreRefusedWithTheirLine) {
  const auto error = [](const char* prompts) {
    const auto lesson = UnitLesson::Parse("p.txt", prompts, Usual());
    return lesson ? std::string("none") : lesson.error().text;
  };
  EXPECT_EQ(error("show 1 2 12\nshow 2.5 4 4 0.5\n"), "none");
  EXPECT_EQ(error(""), "p.txt: 1 to 100 rows 'show' expected");
  EXPECT_EQ(error("look 1 2 12\n"), "p.txt:1: expected 'show'");
  EXPECT_EQ(error("show 1 3 12\nshow 2 4 4\n"),
            "p.txt:2: expected times that rise, the first after the face has been at rest");
  EXPECT_EQ(error("show 0 3 12\n"),
            "p.txt:1: expected times that rise, the first after the face has been at rest");
  EXPECT_EQ(error("show 1 12 12\n"), "p.txt:1: expected an end up to 10 s after the begin");
  EXPECT_EQ(error("show 1 2 12\nshow 3 4 12\n"), "p.txt:2: unit 12 comes twice");
  EXPECT_EQ(error("show 1 2 99\n"), "p.txt:1: unit 99 is none that is followed");
  EXPECT_EQ(error("show 1 2 12 0.5 1\n"), "p.txt:1: '1' is one word too many");
}

}  // namespace
}  // namespace facetrack
