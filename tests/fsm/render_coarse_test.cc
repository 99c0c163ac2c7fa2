// Small faces are drawn with fewer triangles: what is left out, and that it is not missed.

#include <cstdlib>
#include <set>
#include <string>
#include <utility>

#include "fsm/faces/face_of_name.h"
#include "fsm/head/make_head.h"
#include "fsm/render/appearance.h"
#include "fsm/render/coarse_mesh.h"
#include "fsm/render/renderer.h"
#include "tests/fsm/golden_picture.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

/// Draws square pictures with all triangles, or with those that the program draws.
class Easel {
 public:
  explicit Easel(int side)
      : context_(RenderContext::MakeHeadless(side, side)), renderer_(Renderer::Make(*context_)) {}
  Image Draw(const Head& head, const FaceState& state, bool all) {
    renderer_->SetMaxErrorPixels(all ? 0 : Appearance::BuiltIn().form_error);
    renderer_->Draw(head, state, {}, Scene{});
    Image image;
    renderer_->Read(image);
    return image;
  }

 private:
  std::unique_ptr<RenderContext> context_;
  std::unique_ptr<Renderer> renderer_;
};

/// At rest, a smile turned aside, and surprise with shut eyes.
std::vector<FaceState> States() {
  std::vector<FaceState> states(3);
  for (const std::size_t unit : {6U, 12U, 25U}) {
    states[1].au.left[unit] = states[1].au.right[unit] = 0.8F;
  }
  states[1].head_rotation[1] = 25;
  states[2].blink.left = states[2].blink.right = 1;
  states[2].au.left[1] = states[2].au.right[1] = 1;
  states[2].mouth[kJawY] = 14;
  return states;
}

/// The built-in heads, and one that wears a photo.
std::unique_ptr<Head> HeadNamed(const std::string& name) {
  setenv("GALATEA_FACES", GALATEA_SOURCE_DIR "/tests/fsm/data", 1);
  return MakeHeadOfName(name);
}

class SmallFaceTest : public testing::TestWithParam<std::string> {};

TEST_P(SmallFaceTest, LooksAsWithAllOfItsTriangles) {
  const auto head = HeadNamed(GetParam());
  for (const int side : {96, 256}) {
    Easel easel(side);
    for (const FaceState& state : States()) {
      const FigureDifference off = CompareFigures(
          easel.Draw(*head, state, true), easel.Draw(*head, state, false), kPlainBackground);
      EXPECT_GT(off.mean, 0) << "none was left out";
      // Frayed ends of hair differ most: other hairs of the same pattern are gone.
      EXPECT_LT(off.mean, 4) << "at " << side;
      EXPECT_LT(off.worst_tile, 32) << "at " << side;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Heads, SmallFaceTest,
                         testing::Values("galatea", "pygmalion", "baucis", "worn"),
                         [](const auto& entry) { return entry.param; });

/// The edges of a part that bound it: those of one triangle only.
std::set<std::pair<std::uint32_t, std::uint32_t>> BorderOf(const HeadTriangles& triangles,
                                                           const HeadSurface::Part& part) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> border;
  for (std::uint32_t k = part.first_index; k < part.first_index + part.index_count; ++k) {
    const std::uint32_t a = triangles.indices[k];
    const std::uint32_t next = k % 3 == 2 ? k - 2 : k + 1;
    const auto edge = std::minmax(a, triangles.indices[next]);
    if (!border.insert(edge).second) border.erase(edge);
  }
  return border;
}

TEST(CoarseTrianglesTest, ManyAreLeftOutAndNothingComesApart) {
  const auto head = MakeHead("galatea");
  const HeadTriangles all{head->surface().parts, head->surface().indices};
  const HeadTriangles fine = CoarseTriangles(*head, {}, 1e-4F);
  const HeadTriangles coarse = CoarseTriangles(*head, {}, 1);
  EXPECT_LT(coarse.indices.size(), all.indices.size() / 2);
  EXPECT_GT(fine.indices.size(), all.indices.size() * 9 / 10);
  ASSERT_EQ(coarse.parts.size(), all.parts.size());
  for (std::size_t i = 0; i < all.parts.size(); ++i) {
    EXPECT_EQ(coarse.parts[i].material, all.parts[i].material);
    EXPECT_GT(coarse.parts[i].index_count, 0U) << i;
    if (IsHair(all.parts[i].material)) continue;
    EXPECT_EQ(BorderOf(coarse, coarse.parts[i]), BorderOf(all, all.parts[i])) << i;
  }
}

}  // namespace
}  // namespace fsm
