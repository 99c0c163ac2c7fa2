#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>

#include "fsm/head/make_head.h"
#include "fsm/image/image_file.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

/// One kept picture: a face, how it moves and how it is seen.
struct Golden {
  const char* name;
  const char* identity;
  std::vector<std::pair<std::size_t, float>> units;
  float turn_degrees;
  Camera camera;
};

const Golden kGoldens[] = {
    {"rest", "galatea", {}, 0, {}},
    {"smile",
     "galatea",
     {{6, 0.8F}, {12, 0.9F}, {25, 0.4F}},
     0,
     {.distance = 0.6F, .height_mm = 10}},
    {"brows",
     "pygmalion",
     {{1, 1.0F}, {2, 1.0F}, {26, 0.4F}},
     0,
     {.distance = 0.6F, .height_mm = 30}},
    {"turned", "galatea", {}, 40, {}},
    {"eyes", "baucis", {{5, 0.5F}}, -10, {.distance = 0.3F, .height_mm = 25}},
};

Image Draw(const Golden& golden) {
  constexpr int kSide = 176;
  const auto head = MakeHead(golden.identity);
  FaceState state;
  for (const auto& [unit, strength] : golden.units) {
    state.au_left[unit] = state.au_right[unit] = strength;
  }
  state.head_rotation[1] = golden.turn_degrees;
  Scene scene;
  scene.camera = golden.camera;
  const auto context = RenderContext::MakeHeadless(kSide, kSide);
  const auto renderer = Renderer::Make(*context);
  HeadVertices vertices;
  head->Evaluate(state, vertices);
  renderer->Draw(*head, vertices, state, scene);
  Image image;
  renderer->Read(image);
  return image;
}

std::string Path(const Golden& golden) {
  return std::string(GALATEA_SOURCE_DIR "/tests/fsm/data/golden/") + golden.name + ".png";
}

class GoldenTest : public ::testing::TestWithParam<Golden> {};

/// Another Mesa or processor may round otherwise: the mean difference of a channel is at most 1.5
/// of 255, and at most 1 pixel in 100 differs by more than 24. scripts/renew_goldens.sh makes new
/// ones.
TEST_P(GoldenTest, LooksAsKept) {
  const Image now = Draw(GetParam());
  if (std::getenv("GALATEA_RENEW_GOLDENS") != nullptr) {
    std::filesystem::create_directories(std::filesystem::path(Path(GetParam())).parent_path());
    const auto written = WriteImage(now, Path(GetParam()));
    ASSERT_TRUE(written) << written.error().text;
    GTEST_SKIP() << "renewed " << Path(GetParam());
  }
  const auto kept = ReadImage(Path(GetParam()));
  ASSERT_TRUE(kept) << kept.error().text;
  ASSERT_EQ(kept->width, now.width);
  ASSERT_EQ(kept->height, now.height);
  double sum = 0;
  std::size_t far = 0;
  std::array<int, 4> box{now.width, now.height, -1,
                         -1};  // of what is far: left, top, right, bottom
  for (std::size_t i = 0; i < now.rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t c = i; c < i + 4; ++c) {
      const int difference = std::abs(now.rgba[c] - kept->rgba[c]);
      sum += difference;
      most = std::max(most, difference);
    }
    if (most <= 24) continue;
    ++far;
    const int x = static_cast<int>(i / 4) % now.width;
    const int y = static_cast<int>(i / 4) / now.width;
    box = {std::min(box[0], x), std::min(box[1], y), std::max(box[2], x), std::max(box[3], y)};
  }
  const auto explain = [&] {
    const std::string path = ::testing::TempDir() + GetParam().name + "_now.png";
    const auto written = WriteImage(now, path);
    return "they differ from " + std::to_string(box[0]) + "," + std::to_string(box[1]) + " to " +
           std::to_string(box[2]) + "," + std::to_string(box[3]) + "; the picture drawn now is " +
           (written ? path : "not kept: " + written.error().text);
  };
  EXPECT_LE(sum / static_cast<double>(now.rgba.size()), 1.5) << explain();
  EXPECT_LE(far, now.rgba.size() / 400) << explain();
}

INSTANTIATE_TEST_SUITE_P(All, GoldenTest, ::testing::ValuesIn(kGoldens),
                         [](const auto& test) { return std::string(test.param.name); });

/// The lower corners show the shirt, on triangles the picture's edge cuts through.
TEST(ClippedTest, ClothThatLeavesThePictureKeepsItsColour) {
  for (const auto& identity : Identities()) {
    const Image image = Draw(
        {"", std::string(identity.name).c_str(), {}, 0, {.distance = 0.55F, .height_mm = -40}});
    for (const int x : {1, 20, image.width - 21, image.width - 2}) {
      const auto i = static_cast<std::size_t>((image.height - 2) * image.width + x) * 4;
      const int light = image.rgba[i] + image.rgba[i + 1] + image.rgba[i + 2];
      EXPECT_GT(light, 90) << identity.name << " at x " << x;
    }
  }
}

}  // namespace
}  // namespace fsm
