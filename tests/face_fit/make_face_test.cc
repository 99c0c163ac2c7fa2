#include "face_fit/make_face.h"

#include <gtest/gtest.h>

#include "fsm/head/make_head.h"
#include "fsm/render/renderer.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {
namespace {

TEST(ChooseFaceTest, FacesAreCountedFromOneAndThereIsNoOther) {
  std::vector<FoundFace> faces(2);
  faces[1].score = 0.6F;
  ASSERT_TRUE(ChooseFace(faces, 2));
  EXPECT_EQ(ChooseFace(faces, 2)->score, 0.6F);
  for (const int number : {-1, 0, 3}) {
    const auto face = ChooseFace(faces, number);
    ASSERT_FALSE(face) << number;
    EXPECT_EQ(face.error().text,
              "face " + std::to_string(number) + ": there are 2, counted from the largest");
  }
  EXPECT_FALSE(ChooseFace({}, 1));
}

TEST(ExtrasTest, PhotosFromTheSideNeedNetworksAndAreNotTooMany) {
  EXPECT_TRUE(CheckExtras(nullptr, {}));
  const auto blind = CheckExtras(nullptr, ExtraPhotos(1));
  ASSERT_FALSE(blind);
  EXPECT_EQ(blind.error().code, vm::Errc::kUnavailable);
  const auto many = CheckExtras(nullptr, ExtraPhotos(kMostExtraPhotos + 1));
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().code, vm::Errc::kLimit);
}

TEST(ExtrasTest, NoFaceIsMadeOfPhotosFromTheSideWithoutNetworks) {
  EXPECT_THROW(MakeFace(BaseHead{}, {}, {}, nullptr, ExtraPhotos(1)), std::runtime_error);
}

using MakeFaceTest = NetworkTest;

TEST_F(MakeFaceTest, APhotoThatDoesNotHelpIsLeftOutWithItsReasonAndTheRestIsMade) {
  constexpr int kSide = 500;
  const auto head = fsm::MakeHead("baucis");
  fsm::HeadVertices vertices;
  head->Evaluate({}, vertices);
  const auto context = fsm::RenderContext::MakeHeadless(kSide, kSide);
  const auto renderer = fsm::Renderer::Make(*context);
  renderer->Draw(*head, vertices, {}, fsm::Scene{});
  fsm::Image photo;
  renderer->Read(photo);
  const auto faces = FindFaces(*networks_, photo);
  const FoundFace face = vm::OrThrow(ChooseFace(faces, 1));
  const FrontPhoto front = LookAtFront(*networks_, Galatea(), photo, &face, 1);
  const ExtraPhotos again{std::make_shared<const ExtraPhoto>("again.png", photo, faces)};
  std::string steps;
  const MadeFace made = MakeFace(Galatea(), front, face, &*networks_, again, true,
                                 [&](const char* step) { steps += std::string(step) + ";"; });
  ASSERT_EQ(made.left_out.size(), 1U);
  EXPECT_EQ(made.left_out[0].path, "again.png");
  EXPECT_NE(made.left_out[0].why.find("from the front"), std::string::npos);
  EXPECT_TRUE(made.bake.head.glasses) << "as it was told, though none are there";
  EXPECT_NE(made.report.find("glasses     yes"), std::string::npos) << made.report;
  EXPECT_NE(made.report.find("faces       1\n"), std::string::npos);
  EXPECT_EQ(steps, "head fitted;photo put on;");
  EXPECT_EQ(made.bake.head.base, "galatea");
}

}  // namespace
}  // namespace facefit
