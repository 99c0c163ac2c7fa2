// A figure that fades (Figure::alpha) is one picture over what is behind it.

#include <algorithm>
#include <cmath>

#include "fsm/head/make_head.h"
#include "tests/fsm/render_support.h"
#include "tests/fsm/wearing_photo.h"

namespace fsm {
namespace {

constexpr int kWidth = 200, kHeight = 240;

struct FadeTest : ::testing::Test {
  Image Draw(const Head& head, float alpha) {
    FaceState state;
    state.figure.alpha = alpha;
    state.au.left[26] = state.au.right[26] = 0.5F;  // the mouth is open: there is an inside
    head.Evaluate(state, vertices_);
    renderer_->DrawVertices(head, vertices_, state.figure, scene_);
    Image image;
    renderer_->Read(image);
    return image;
  }

  /// That every pixel of the faded picture lies at `alpha` between the empty and the whole one.
  void ExpectOnePicture(const Head& head, const std::string& what) {
    const Image whole = Draw(head, 1);  // first: beside a photo the background is read as softly
    const Image nothing = Draw(head, 0);
    for (const float alpha : {0.98F, 0.5F, 0.1F}) {
      const Image faded = Draw(head, alpha);
      std::size_t far = 0;
      int most = 0;
      for (std::size_t i = 0; i < faded.rgba.size(); ++i) {
        const std::size_t opacity = i / 4 * 4 + 3;
        // Colours without a background are those of the figure, as far as 8 bits keep them when
        // they are multiplied by the opacity.
        const bool open = nothing.rgba[opacity] == 0 && i != opacity;
        if (open && faded.rgba[opacity] < 128) continue;
        const float should = open ? static_cast<float>(whole.rgba[i])
                                  : std::lerp(static_cast<float>(nothing.rgba[i]),
                                              static_cast<float>(whole.rgba[i]), alpha);
        const int off = static_cast<int>(std::abs(static_cast<float>(faded.rgba[i]) - should));
        most = std::max(most, off);
        far += off > (open ? 4 : 2);
      }
      EXPECT_EQ(far, 0U) << what << " at " << alpha << ", at most " << most << " levels off";
    }
    EXPECT_EQ(Draw(head, 1).rgba, whole.rgba) << what << ": fading left something behind";
  }

  Scene scene_;
  HeadVertices vertices_;
  std::unique_ptr<RenderContext> context_ = RenderContext::MakeHeadless(kWidth, kHeight);
  std::unique_ptr<Renderer> renderer_ = Renderer::Make(*context_);
};

TEST_F(FadeTest, AHeadThatWearsAPhotoDoesNotTear) {
  const auto head = WearingPhoto();
  scene_.background = glm::vec3(0, 0, 1);
  ExpectOnePicture(*head, "before a colour");
  scene_.background = Transparent{};
  ExpectOnePicture(*head, "before nothing");
}

TEST_F(FadeTest, BuiltInHeadsDoNotShowTheirInside) {
  for (const std::string& identity : Identities()) {
    const auto head = MakeHead(identity);
    ExpectOnePicture(*head, identity);
  }
}

TEST_F(FadeTest, WhatIsBehindMayBeAPictureOfAnySize) {
  const auto head = WearingPhoto();
  for (const int width : {kWidth, 37, 500}) {
    scene_.background = std::make_shared<const Image>(Pattern(width, kHeight));
    ExpectOnePicture(*head, std::to_string(width) + " wide");
  }
}

TEST_F(FadeTest, LinesFadeWithTheFigure) {
  const auto head = WearingPhoto();
  for (const ViewMode mode : {ViewMode::kWireframe, ViewMode::kTextureWithWireframe}) {
    scene_.view_mode = mode;
    ExpectOnePicture(*head, mode == ViewMode::kWireframe ? "lines" : "lines over the skin");
  }
}

}  // namespace
}  // namespace fsm
