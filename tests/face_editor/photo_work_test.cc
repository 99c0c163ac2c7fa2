#include "face_editor/core/photo_work.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "fsm/head/make_head.h"
#include "fsm/image/image_file.h"
#include "fsm/render/renderer.h"

namespace editor {
namespace {

/// A picture of a built-in head, drawn into a file.
void DrawHead(const std::string& face, const std::string& path, float turned_degrees) {
  constexpr int kSide = 640;
  const auto head = fsm::MakeSymmetricHead(face);
  fsm::HeadVertices vertices;
  head->Evaluate({}, vertices);
  const auto context = fsm::RenderContext::MakeHeadless(kSide, kSide);
  const auto renderer = fsm::Renderer::Make(*context);
  fsm::Scene scene;
  scene.camera.angle_degrees = turned_degrees;
  renderer->DrawVertices(*head, vertices, {}, scene);
  fsm::Image image;
  renderer->Read(image);
  ASSERT_TRUE(fsm::WriteImage(image, path));
}

class PhotoWorkTest : public testing::TestWithParam<const char*> {};

// In full profile the network finds no face of those whose hair hangs beside it.
INSTANTIATE_TEST_SUITE_P(Faces, PhotoWorkTest, testing::Values("pygmalion", "memnon"),
                         [](const auto& face) { return std::string(face.param); });

TEST_P(PhotoWorkTest, AFullProfileIsTakenAndTheFrontIsNot) {
  const auto models = LoadFaceModels("", "");
  if (!models) GTEST_SKIP() << models.error().text;
  std::string folder = testing::TempDir() + "/work_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  DrawHead(GetParam(), folder + "/front.png", 0);
  const auto work = OpenPhoto(models->get(), folder + "/front.png", 1);
  ASSERT_TRUE(work) << work.error().text;
  const auto open = [&](const std::string& name) {
    return OpenSidePhoto(**models, **work, (*work)->found, folder + "/" + name);
  };
  for (const float turned : {-90.0F, 90.0F}) {
    DrawHead(GetParam(), folder + "/side.png", turned);
    const auto side = open("side.png");
    EXPECT_TRUE(side) << turned << ": " << side.error().text;
  }
  const auto front = open("front.png");
  ASSERT_FALSE(front);
  EXPECT_TRUE(front.error().text.starts_with(folder + "/front.png: ")) << front.error().text;
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace editor
