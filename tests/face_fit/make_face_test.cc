#include "face_fit/make_face.h"

#include <gtest/gtest.h>

#include "face_fit/find/network/face_finder.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"
#include "fsm/head/make_head.h"
#include "fsm/render/renderer.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {
namespace {

using MakeFaceTest = NetworkTest;

fsm::Image GreyPhoto() {
  return {.width = 200, .height = 150, .rgba = std::vector<std::uint8_t>(200 * 150 * 4, 128)};
}

TEST_F(MakeFaceTest, WhereNoFaceIsFoundTheFigureAloneIsCutOut) {
  for (const FaceChoice& choice : {FaceChoice(FaceNumber{}), FaceChoice(FaceNear{{100, 75}})}) {
    const auto front = vm::OrThrow(
        PrepareFront(*networks_, Galatea(), GreyPhoto(), choice, PhotoExtent::kCloseUp));
    EXPECT_FALSE(front.face);
    EXPECT_EQ(front.photo.face_count, 0);
    EXPECT_EQ(front.photo.figure.opacity.width, 200);
  }
}

TEST_F(MakeFaceTest, FacesAreCountedFromOneAndThereIsNoOther) {
  for (const int number : {-1, 0, 2}) {
    const auto front = PrepareFront(*networks_, Galatea(), Galatea().portrait().image,
                                    FaceNumber{number}, PhotoExtent::kWhole);
    ASSERT_FALSE(front) << number;
    EXPECT_EQ(front.error().text,
              "face " + std::to_string(number) + ": there are 1, counted from the largest");
  }
}

TEST_F(MakeFaceTest, PointsSetByHandBesideThePhotoAreRefused) {
  const HandPoints points{{point::kEyeOuterRight, {600, 300}}, {point::kEyeOuterLeft, {720, 300}},
                          {point::kNoseTip, {662, 365}},       {point::kMouthRight, {625, 410}},
                          {point::kMouthLeft, {695, 410}},     {point::kChin, {660, 480}}};
  const auto front =
      PrepareFront(*networks_, Galatea(), GreyPhoto(), points, PhotoExtent::kCloseUp);
  ASSERT_FALSE(front);
  EXPECT_TRUE(front.error().text.starts_with("none of the points lies in the photo"))
      << front.error().text;
}

/// The built-in head as the networks see it, or a part of it.
fsm::Image PartOfPortrait(const ObservedHead& head, glm::vec2 low, glm::vec2 high) {
  const glm::ivec2 from(low), size(high - low);
  return Cropped(head.portrait().image, from.x, from.y, size.x, size.y);
}

TEST_F(MakeFaceTest, OfAPhotoThatShowsOnlyTheInnerFaceTheRestIsDrawnAndNamed) {
  const glm::vec2 right = Galatea().portrait().pixels[point::kCheekRight],
                  left = Galatea().portrait().pixels[point::kCheekLeft],
                  brow = Galatea().portrait().pixels[point::kBrowRight],
                  chin = Galatea().portrait().pixels[point::kChin];
  const auto front = vm::OrThrow(
      PrepareFront(*networks_, Galatea(),
                   PartOfPortrait(Galatea(), {right.x + 5, brow.y - 15}, {left.x - 5, chin.y + 2}),
                   FaceNumber{}, PhotoExtent::kCloseUp));
  ASSERT_TRUE(front.face);
  const auto made = vm::OrThrow(MakeFace(Galatea(), front.photo, *front.face));
  EXPECT_NE(
      made.report.find("cuts off part of the head: the forehead, the right ear, the left ear"),
      std::string::npos)
      << made.report;
  // The face is painted in the photo's colours, not in the black of a figure that was not found.
  const fsm::Image& map = *made.baked.head.atlas;
  EXPECT_GT(Brightness(Rgb(map, map.Index(map.width / 4, map.height / 2))), 60);
}

TEST_F(MakeFaceTest, APhotoWithoutTheMouthIsRefused) {
  const glm::vec2 nose = Galatea().portrait().pixels[point::kNoseBottom];
  const fsm::Image& portrait = Galatea().portrait().image;
  auto front =
      vm::OrThrow(PrepareFront(*networks_, Galatea(), portrait, FaceNumber{}, PhotoExtent::kWhole));
  ASSERT_TRUE(front.face);
  front.photo.image = PartOfPortrait(Galatea(), {0, 0}, {portrait.width, nose.y + 4});
  const auto made = MakeFace(Galatea(), front.photo, *front.face);
  ASSERT_FALSE(made);
  EXPECT_TRUE(made.error().text.starts_with("the photo cuts off the mouth; ")) << made.error().text;
}

TEST_F(MakeFaceTest, APhotoThatDoesNotHelpIsLeftOutWithItsReasonAndTheRestIsMade) {
  constexpr int kSide = 500;
  const auto head = fsm::MakeHead("baucis");
  fsm::HeadVertices vertices;
  head->Evaluate({}, vertices);
  const auto context = fsm::RenderContext::MakeHeadless(kSide, kSide);
  const auto renderer = fsm::Renderer::Make(*context);
  renderer->DrawVertices(*head, vertices, {}, fsm::Scene{});
  fsm::Image photo;
  renderer->Read(photo);
  std::string steps;
  const auto tell = [&](const char* step) { steps += std::string(step) + ";"; };
  const auto front = vm::OrThrow(
      PrepareFront(*networks_, Galatea(), photo, FaceNumber{}, PhotoExtent::kCloseUp, tell));
  ASSERT_TRUE(front.face);
  const SidePhoto again{"again.png", photo, FindFaces(*networks_, photo).front()};
  const std::vector<const SidePhoto*> sides{&again};
  const auto made = vm::OrThrow(
      MakeFace(Galatea(), front.photo, *front.face, SidePhotoSet{*networks_, sides}, true, tell));
  ASSERT_EQ(made.rejected.size(), 1U);
  EXPECT_EQ(made.rejected[0].path, "again.png");
  EXPECT_NE(made.rejected[0].reason.find("from the front"), std::string::npos);
  EXPECT_TRUE(made.baked.head.glasses) << "as it was told, though none are there";
  EXPECT_NE(made.report.find("glasses     yes"), std::string::npos) << made.report;
  EXPECT_NE(made.report.find("faces       1\n"), std::string::npos);
  EXPECT_EQ(steps, "faces and their points found;figure cut out;head fitted;photo put on;");
  EXPECT_EQ(made.baked.head.base, "galatea");
}

}  // namespace
}  // namespace facefit
