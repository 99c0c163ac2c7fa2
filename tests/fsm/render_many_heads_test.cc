// Several heads and several frames in one renderer.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "fsm/render/appearance.h"
#include "fsm/render/backdrop.h"
#include "fsm/render/frame_reader.h"
#include "fsm/render/gpu_rig.h"
#include "fsm/render/renderer.h"
#include "tests/fsm/ball_head.h"
#include "tests/fsm/render_support.h"
#include "tests/fsm/wearing_photo.h"

namespace fsm {
namespace {

TEST(ManyHeadsTest, DrawnInTurnsTheyLookAsAlone) {
  const auto context = RenderContext::MakeHeadless(160, 160);
  // More of them than are kept; one wears a photo. Another size wants skin in other detail.
  std::vector<std::unique_ptr<Head>> heads;
  heads.push_back(MakeHead("galatea"));
  heads.push_back(std::make_unique<BallHead>());
  heads.push_back(WearingPhoto());
  heads.push_back(MakeHead(Identities().back()));
  const auto picture = [](Renderer& renderer, const Head& head, int size) {
    FaceState state;
    state.au.left[12] = state.au.right[26] = 0.8F;
    HeadVertices vertices;
    head.Evaluate(state, vertices);
    renderer.SetViewport({0, 0, size, size});
    renderer.DrawVertices(head, vertices, state.figure, {});
    Image image;
    renderer.Read(image);
    return image.rgba;
  };
  for (const std::size_t kept : {2U, 8U}) {
    const auto shared = Renderer::Make(*context, kept);
    for (const int size : {160, 40, 160}) {
      for (const auto& head : heads) {
        SCOPED_TRACE(size);
        const auto alone = Renderer::Make(*context);
        EXPECT_EQ(picture(*shared, *head, size), picture(*alone, *head, size));
      }
    }
  }
}

TEST(ManyHeadsTest, FacesDrawnInOneCallLookAsOneByOne) {
  const auto context = RenderContext::MakeHeadless(80, 64);
  const auto plain = MakeHead("galatea");
  const auto photo = WearingPhoto();
  const BallHead ball;
  std::vector<FaceState> states(6);
  for (std::size_t k = 0; k < states.size(); ++k) {
    states[k].au.left[12] = states[k].au.right[26] = 0.2F * static_cast<float>(k);
  }
  Scene scene;
  scene.background = glm::vec3(0.1F, 0.4F, 0.7F);
  // The second of the two runs of one head has fewer faces, and a head comes twice.
  const std::vector<Pane> panes{{plain.get(), &states[0], &scene, {0, 0, 40, 64}},
                                {plain.get(), &states[1], &scene, {40, 0, 40, 64}},
                                {plain.get(), &states[2], &scene, {}},
                                {photo.get(), &states[3], &scene, {0, 0, 40, 64}},
                                {&ball, &states[4], &scene, {0, 0, 40, 64}},
                                {plain.get(), &states[5], &scene, {0, 0, 40, 64}}};
  for (const RigDevice rig : {RigDevice::kProcessor, RigDevice::kGpu}) {
    if (rig == RigDevice::kGpu && !RigPrograms::Supported(GlFunctions::Load(*context))) continue;
    const auto renderer = Renderer::Make(*context, 2, Appearance::BuiltIn(), rig);
    std::vector<Image> expected, drawn;
    for (const Pane& pane : panes) {
      renderer->SetViewport(pane.viewport);
      renderer->Draw(*pane.head, *pane.state, pane.spring_offsets, *pane.scene);
      renderer->Read(expected.emplace_back());
    }
    renderer->SetViewport({0, 0, 10, 20});
    renderer->DrawPanes(panes, [&](std::size_t k) {
      EXPECT_EQ(k, drawn.size());
      renderer->Read(drawn.emplace_back());
    });
    ASSERT_EQ(drawn.size(), panes.size());
    for (std::size_t k = 0; k < panes.size(); ++k) {
      EXPECT_EQ(drawn[k].width, panes[k].viewport.width > 0 ? 40 : 80) << k;
      EXPECT_EQ(drawn[k].rgba, expected[k].rgba) << k;
    }
    EXPECT_NE(drawn[0].rgba, drawn[1].rgba);
    renderer->Draw(ball, states[0], {}, scene);
    renderer->Read(drawn[0]);
    EXPECT_EQ(drawn[0].width, 10) << "the viewport set before is back";
  }
}

/// Frames of two sizes, on a background and on none, of a head that is read softly and one that is
/// not.
struct Frame {
  const Head& head;
  int size;
  bool transparent;
  float smile;
};

void Draw(Renderer& renderer, const Frame& frame) {
  FaceState state;
  state.au.left[12] = state.au.right[12] = frame.smile;
  HeadVertices vertices;
  frame.head.Evaluate(state, vertices);
  Scene scene;
  if (frame.transparent) scene.background = Transparent{};
  renderer.SetViewport({0, 0, frame.size, frame.size});
  renderer.DrawVertices(frame.head, vertices, state.figure, scene);
}

TEST(FrameReaderTest, FramesReadWhileOthersAreDrawnAreThoseReadAtOnce) {
  const auto context = RenderContext::MakeHeadless(96, 96);
  const auto renderer = Renderer::Make(*context);
  const auto plain = MakeHead("galatea");
  const auto photo = WearingPhoto();
  const Frame frames[] = {{*plain, 96, false, 0.0F}, {*photo, 96, false, 0.5F},
                          {*plain, 96, true, 0.5F},  {*plain, 63, false, 1.0F},
                          {*photo, 96, true, 1.0F},  {*plain, 96, false, 1.0F}};
  std::vector<Image> expected;
  for (const Frame& frame : frames) {
    Draw(*renderer, frame);
    renderer->Read(expected.emplace_back());
  }
  for (const std::size_t behind : {0U, 1U, 2U, 5U}) {
    SCOPED_TRACE(behind);
    std::vector<std::uint64_t> begun;
    std::vector<Image> read;
    const auto end_first = [&] {
      const std::uint64_t first = begun[read.size()];
      renderer->EndRead(first, read.emplace_back());
    };
    for (const Frame& frame : frames) {
      Draw(*renderer, frame);
      begun.push_back(renderer->BeginRead());
      if (begun.size() > read.size() + behind) end_first();
    }
    while (read.size() < begun.size()) end_first();
    for (std::size_t i = 0; i < read.size(); ++i) {
      EXPECT_EQ(read[i].width, frames[i].size);
      EXPECT_EQ(read[i].rgba, expected[i].rgba) << i;
    }
  }
}

TEST(FrameReaderTest, BuffersHandOutWhatIsReadAtOnce) {
  const auto context = RenderContext::MakeHeadless(40, 30);
  const GlFunctions gl = GlFunctions::Load(*context);
  Backdrop backdrop(gl, Appearance::BuiltIn());
  FrameReader buffered(gl, true), at_once(gl, false);
  GlFramebuffer target(gl, 40, 30);
  std::vector<std::array<std::uint64_t, 2>> begun;
  std::vector<Image> expected;
  for (int i = 0; i < 5; ++i) {
    target.Bind();
    // The picture is stretched, so that every sample is another.
    backdrop.Draw(std::make_shared<const Image>(Pattern(53, 37, 11 * i)), 40, 30);
    const Filter filter = i % 2 == 1 ? Filter::kSoft : Filter::kBox;
    target.Read(expected.emplace_back(), filter);
    begun.push_back({buffered.Begin(target, {filter}), at_once.Begin(target, {filter})});
  }
  EXPECT_NE(expected[0].rgba, expected[2].rgba);
  buffered.Drop(begun[1][0]);
  Image image;
  for (const std::size_t i : {2U, 0U, 4U, 3U}) {
    buffered.End(begun[i][0], image);
    EXPECT_EQ(image.rgba, expected[i].rgba) << i;
    at_once.End(begun[i][1], image);
    EXPECT_EQ(image.rgba, expected[i].rgba) << i;
    EXPECT_EQ(image.width, 40);
  }
}

TEST(FrameReaderTest, FramesEndInAnyOrderOrAreDroppedAndAPictureBetweenThemIsItsOwn) {
  const auto context = RenderContext::MakeHeadless(64, 64);
  const auto renderer = Renderer::Make(*context);
  const BallHead ball;
  const auto photo = WearingPhoto();
  Image of_ball, of_photo, image;
  Draw(*renderer, {ball, 64, false, 0});
  renderer->Read(of_ball);
  Draw(*renderer, {*photo, 64, false, 0});
  renderer->Read(of_photo);
  Draw(*renderer, {ball, 64, false, 0});
  const auto first = renderer->BeginRead();
  Draw(*renderer, {*photo, 64, false, 0});
  const auto second = renderer->BeginRead();
  Draw(*renderer, {ball, 64, false, 0});
  const auto dropped = renderer->BeginRead();
  Draw(*renderer, {*photo, 64, false, 0});
  renderer->Read(image);
  EXPECT_EQ(image.rgba, of_photo.rgba);
  renderer->DropRead(dropped);
  renderer->EndRead(second, image);
  EXPECT_EQ(image.rgba, of_photo.rgba);
  renderer->EndRead(first, image);
  EXPECT_EQ(image.rgba, of_ball.rgba);
  Draw(*renderer, {ball, 64, false, 0});
  renderer->BeginRead();  // one that is never ended goes with the renderer
}

}  // namespace
}  // namespace fsm
