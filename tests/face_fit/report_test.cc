// What is said of a photo that will not do.

#include "face_fit/report.h"

#include <gtest/gtest.h>

#include <glm/trigonometric.hpp>
#include <optional>
#include <string>
#include <utility>

#include "fsm/head/make_head.h"

namespace facefit {
namespace {

struct ReportTest : testing::Test {
  ReportTest() {
    face.found.points.fill(glm::vec3(100, 100, 0));
    face.found.points[33].x = 50;
    face.found.points[263].x = 150;
    face.found.crop = {glm::vec2(100), 150, 0};
    Cover(0.5F, "the nose");
    front.image.rgba.assign(200 * 200 * 4, 128);
    fit.head.base = &base;
    fit.head.vertices = base.rest().position;
    for (PhotoIris* iris : {&fit.irises.eyes.right, &fit.irises.eyes.left}) iris->seen = true;
  }
  bool Says(const std::string& what) const {
    return Report(front, face, fit, completed, baked).find(what) != std::string::npos;
  }

  void Cover(float covered, std::optional<std::string> part_name) {
    face.occlusion = Occlusion{covered, std::move(part_name)};
  }

  const ObservedHead base = ObservedHead::Exact(fsm::MakeHead("galatea"), "galatea", {});
  FrontPhoto front{.image = {.width = 200, .height = 200, .rgba = {}}, .face_count = 1};
  FrontFace face;
  FaceFit fit;
  Completed completed;
  BakedHead baked;
};

TEST_F(ReportTest, ThePlaceOfTheFaceIsThatInTheWholePhoto) {
  front.whole_size_px = {800, 600};
  face.nose_whole_px = {412.6F, 77.2F};
  EXPECT_TRUE(Says("place       nose 413 pixels from the left, 77 from the top, of 800 x 600\n"));
}

TEST_F(ReportTest, AHeadTurnedFarIsToldApartFromOneTurnedALittle) {
  EXPECT_FALSE(Says("turned"));
  fit.head.pose.rotation_rad.y = glm::radians(-17.0F);
  EXPECT_TRUE(Says("the head is turned; one side"));
  fit.head.pose.rotation_rad.y = glm::radians(27.0F);
  EXPECT_TRUE(Says("the head is turned far"));
  EXPECT_TRUE(Says("turned by less than 15 degrees"));
  EXPECT_FALSE(Says("bent"));
}

TEST_F(ReportTest, EyesThatAreShutOrInTheShadeAreSpokenOf) {
  EXPECT_FALSE(Says("iris is"));
  fit.irises.eyes.left.seen = false;
  EXPECT_TRUE(Says("one iris is not seen clearly"));
  fit.irises.eyes.right.seen = false;
  EXPECT_TRUE(Says("no iris is seen"));
}

TEST_F(ReportTest, WhatMayBeBeforeAFaceIsToldApartFromWhatSurelyIs) {
  EXPECT_FALSE(Says("before the face at"));
  Cover(1.2F, "the nose");
  EXPECT_TRUE(Says("may be before the face at the nose"));
  EXPECT_FALSE(Says("covered by"));
  Cover(1.6F, "the nose");
  EXPECT_TRUE(Says("covered by something that is no face: the nose"));
}

TEST_F(ReportTest, WhereAFaceIsCoveredIsNotSaidIfOnlyTheNetworksDoubtTells) {
  Cover(1.2F, {});
  EXPECT_TRUE(Says("something may be before the face;"));
  EXPECT_FALSE(Says("the nose"));
  Cover(1.6F, {});
  EXPECT_TRUE(Says("covered by something that is no face;"));
}

TEST_F(ReportTest, WhatThePhotoCutsOffAndWasDrawnIsNamed) {
  EXPECT_FALSE(Says("cuts the figure"));
  completed = {.neck = true, .shoulders = true, .hair = false};
  EXPECT_TRUE(Says("light: neck, shoulders and clothes below it; a photo"));
  completed = {.neck = false, .shoulders = true, .hair = true};
  EXPECT_TRUE(Says("light: shoulders beside it; hair above or beside it; a photo"));
}

}  // namespace
}  // namespace facefit
