#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>

#include "fsm/head/make_head.h"
#include "fsm/render/camera.h"
#include "fsm/render/gl_functions.h"
#include "tests/fsm/ball_head.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

constexpr int kFrameWidth = 160;
constexpr int kFrameHeight = 120;

using Pixel = std::array<int, 4>;

Pixel At(const Image& image, int x, int y) {
  const auto i = static_cast<std::size_t>(y * image.width + x) * 4;
  return {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2], image.rgba[i + 3]};
}

/// Pixels in which two pictures differ.
int Differing(const Image& a, const Image& b) {
  int count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) count += At(a, x, y) != At(b, x, y);
  }
  return count;
}

/// Two rows of colour, the upper one and the lower one.
Image MakePicture(std::array<int, 3> upper, std::array<int, 3> lower) {
  Image image{2, 2, {}};
  for (const auto& row : {upper, lower}) {
    for (int x = 0; x < 2; ++x) {
      for (const int value : row) image.rgba.push_back(static_cast<std::uint8_t>(value));
      image.rgba.push_back(255);
    }
  }
  return image;
}

class FrameTest : public ::testing::Test {
 protected:
  FrameTest()
      : context_(RenderContext::MakeHeadless(kFrameWidth, kFrameHeight)),
        renderer_(Renderer::Make(*context_)) {
    head_.Evaluate(state_, vertices_);
    scene_.background = glm::vec3(0.2F, 0.4F, 0.6F);
  }

  Image Draw() {
    Image image;
    renderer_->DrawVertices(head_, vertices_, state_.figure, scene_);
    renderer_->Read(image);
    return image;
  }

  static constexpr Pixel kBackground{51, 102, 153, 255};
  std::unique_ptr<RenderContext> context_;
  std::unique_ptr<Renderer> renderer_;
  BallHead head_;
  HeadVertices vertices_;
  FaceState state_;
  Scene scene_;
};

TEST(EyeColourTest, EachEyeHasItsOwn) {
  const auto context = RenderContext::MakeHeadless(640, 480);
  const auto renderer = Renderer::Make(*context);
  const auto galatea = MakeHead("galatea");
  const auto drawn = [&](glm::vec3 left, glm::vec3 right) {
    HeadAsset asset{galatea->surface(), galatea->rig().data(), galatea->landmarks(), {}};
    asset.surface.eyes.left.iris_colour = left;
    asset.surface.eyes.right.iris_colour = right;
    Image image;
    renderer->Draw(Head(std::move(asset)), FaceState{}, std::span<const glm::vec3>(), Scene{});
    renderer->Read(image);
    return image;
  };
  const glm::vec3 blue(0.05F, 0.1F, 0.4F), brown(0.2F, 0.1F, 0.03F);
  const Image same = drawn(blue, blue), other = drawn(blue, brown);
  // The agent's right eye is in the left half of the picture.
  int left_half = 0, right_half = 0;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      (x < 320 ? left_half : right_half) += At(same, x, y) != At(other, x, y);
    }
  }
  EXPECT_GT(left_half, 20);
  EXPECT_EQ(right_half, 0);
}

TEST_F(FrameTest, HeadStandsInTheMiddleOfTheExactBackground) {
  const Image image = Draw();
  ASSERT_EQ(image.width, kFrameWidth);
  ASSERT_EQ(image.height, kFrameHeight);
  for (const int x : {0, kFrameWidth - 1}) EXPECT_EQ(At(image, x, 0), kBackground);
  const Pixel skin = At(image, kFrameWidth / 2, kFrameHeight / 2);
  EXPECT_GT(skin[0], skin[2] + 10) << "skin is redder than blue";
  EXPECT_EQ(skin[3], 255);
  EXPECT_NE(At(image, kFrameWidth / 2, kFrameHeight - 1), kBackground)
      << "shoulders are at the bottom";
}

TEST_F(FrameTest, SameInputGivesTheSameBytes) {
  const Image first = Draw();
  state_.figure.rotation[1] = 20;
  EXPECT_GT(Differing(first, Draw()), 100);
  state_.figure.rotation[1] = 0;
  EXPECT_EQ(Draw().rgba, first.rgba);
  renderer_.reset();
  context_ = RenderContext::MakeHeadless(kFrameWidth, kFrameHeight);
  renderer_ = Renderer::Make(*context_);
  EXPECT_EQ(Draw().rgba, first.rgba) << "another context";
}

TEST_F(FrameTest, DisabledFigureLeavesTheBackground) {
  state_.figure.enabled = false;
  const Image image = Draw();
  for (int y = 0; y < kFrameHeight; ++y) {
    for (int x = 0; x < kFrameWidth; ++x) ASSERT_EQ(At(image, x, y), kBackground);
  }
  state_.figure.enabled = true;
  state_.figure.alpha = 0;
  EXPECT_EQ(Draw().rgba, image.rgba);
}

TEST_F(FrameTest, AlphaLiesBetweenFigureAndBackground) {
  const Image whole = Draw();
  state_.figure.alpha = 0.5F;
  const Image half = Draw();
  for (const int y : {40, 60, 110}) {
    const Pixel a = At(whole, kFrameWidth / 2, y);
    const Pixel b = At(half, kFrameWidth / 2, y);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(b[c], (a[c] + kBackground[c]) / 2, 2) << y;
    EXPECT_EQ(b[3], 255);
  }
}

TEST_F(FrameTest, WithoutBackgroundTheFigureAloneIsOpaque) {
  scene_.background = Transparent{};
  const Image image = Draw();
  EXPECT_EQ(At(image, 0, 0), (Pixel{0, 0, 0, 0}));
  EXPECT_EQ(At(image, kFrameWidth / 2, kFrameHeight / 2)[3], 255);
  scene_.background = glm::vec3(0.2F, 0.4F, 0.6F);
  const Image before = Draw();
  EXPECT_EQ(At(before, kFrameWidth / 2, kFrameHeight / 2),
            At(image, kFrameWidth / 2, kFrameHeight / 2));
}

TEST_F(FrameTest, FadedFigureWithoutBackgroundKeepsItsColours) {
  scene_.background = Transparent{};
  const Image whole = Draw();
  state_.figure.alpha = 0.25F;
  const Pixel faded = At(Draw(), kFrameWidth / 2, kFrameHeight / 2);
  const Pixel solid = At(whole, kFrameWidth / 2, kFrameHeight / 2);
  EXPECT_NEAR(faded[3], 64, 1);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(faded[c], solid[c], 6);
}

TEST_F(FrameTest, TheStudiosWallIsBrightestBehindTheHeadAndEndsNowhere) {
  scene_.background = StudioWall{};
  state_.figure.enabled = false;
  const Image wall = Draw();
  const Pixel middle = At(wall, kFrameWidth / 2, kFrameHeight * 2 / 5);
  for (const int x : {0, kFrameWidth - 1}) {
    for (const int y : {0, kFrameHeight - 1}) EXPECT_LT(At(wall, x, y)[1] + 20, middle[1]);
  }
  for (int y = 0; y < kFrameHeight; ++y) {
    for (int x = 1; x < kFrameWidth; ++x) EXPECT_NEAR(At(wall, x, y)[1], At(wall, x - 1, y)[1], 3);
  }
  state_.figure.enabled = true;
  state_.figure.alpha = 0;
  EXPECT_EQ(Draw().rgba, wall.rgba) << "a faded figure leaves the wall";
}

TEST_F(FrameTest, PictureOfTheSameSizeIsShownPixelByPixel) {
  const auto picture = std::make_shared<const Image>(Pattern(kFrameWidth, kFrameHeight));
  scene_.background = picture;
  state_.figure.enabled = false;
  EXPECT_EQ(Draw().rgba, picture->rgba);
}

TEST_F(FrameTest, PictureIsStretchedAndUpright) {
  const auto show = [this](std::array<int, 3> top) {
    scene_.background = std::make_shared<const Image>(MakePicture(top, {0, 0, 255}));
  };
  show({255, 0, 0});
  state_.figure.enabled = false;
  const Image image = Draw();
  EXPECT_EQ(At(image, kFrameWidth / 2, 5), (Pixel{255, 0, 0, 255}));
  EXPECT_EQ(At(image, kFrameWidth / 2, kFrameHeight - 5), (Pixel{0, 0, 255, 255}));
  show({0, 255, 0});
  EXPECT_EQ(At(Draw(), kFrameWidth / 2, 5), (Pixel{0, 255, 0, 255}));
}

TEST_F(FrameTest, ViewModesDiffer) {
  const Image texture = Draw();
  scene_.view_mode = ViewMode::kWireframe;
  const Image wireframe = Draw();
  scene_.view_mode = ViewMode::kTextureWithWireframe;
  const Image both = Draw();
  EXPECT_GT(Differing(texture, wireframe), 1000);
  EXPECT_GT(Differing(texture, both), 500);
  EXPECT_GT(Differing(wireframe, both), 1000);
  for (const Image* image : {&wireframe, &both}) EXPECT_EQ(At(*image, 0, 0), kBackground);
  scene_.view_mode = ViewMode::kTexture;
  EXPECT_EQ(Draw().rgba, texture.rgba);
}

TEST_F(FrameTest, FigureIsPlacedAsAsked) {
  scene_.background = Transparent{};
  const auto middle = [this] {
    const Image image = Draw();
    double x_sum = 0;
    double y_sum = 0;
    double count = 0;
    for (int y = 0; y < kFrameHeight; ++y) {
      for (int x = 0; x < kFrameWidth; ++x) {
        if (At(image, x, y)[3] == 0) continue;
        x_sum += x;
        y_sum += y;
        count += 1;
      }
    }
    return std::array<double, 3>{x_sum / count, y_sum / count, count};
  };
  state_.figure.scale = 0.4F;
  const auto before = middle();
  state_.figure.translation = {60, 40};
  const auto moved = middle();
  EXPECT_GT(moved[0], before[0] + 10);
  EXPECT_LT(moved[1], before[1] - 7);
  EXPECT_NEAR(moved[2], before[2], before[2] * 0.05);
  state_.figure.translation = {};
  state_.figure.scale = 0.8F;
  EXPECT_GT(middle()[2], before[2] * 2.5);
}

TEST_F(FrameTest, AnotherHeadIsNoticedAndTheFirstOneToo) {
  const Image ball = Draw();
  auto other = std::make_unique<BallHead>(glm::vec3(0.05F, 0.5F, 0.1F));
  HeadVertices vertices;
  other->Evaluate(state_, vertices);
  renderer_->DrawVertices(*other, vertices, state_.figure, scene_);
  Image green;
  renderer_->Read(green);
  const Pixel pixel = At(green, kFrameWidth / 2, kFrameHeight / 2);
  EXPECT_GT(pixel[1], pixel[0]);
  EXPECT_EQ(Draw().rgba, ball.rgba);
}

/// One thing that a head brings to the renderer, in two ways that are seen in the picture.
struct HeadChange {
  const char* name;
  void (*one)(HeadSurface&);
  void (*other)(HeadSurface&);
};

void PrintTo(const HeadChange& change, std::ostream* out) { *out << change.name; }

void Wear(HeadSurface& topology, std::uint8_t red, std::uint8_t blue) {
  topology.textures.base_colour = std::make_shared<Image>(Image{1, 1, {red, 80, blue, 255}});
  topology.textures.texcoord.assign(topology.albedo.size(), glm::vec2(0.5F));
  topology.textures.weight.assign(topology.albedo.size(), 1);
}

void Comb(HeadSurface& topology, float density) {
  topology.strands.assign(topology.albedo.size(), Strand{.density = density});
}

void Shine(HeadSurface& topology, glm::vec3 glow) {
  PbrMaterial pbr;
  pbr.emissive = glow;
  topology.pbr_materials = {pbr};
  topology.parts.front().pbr = 0;
  Wear(topology, 120, 120);
}

const HeadChange kHeadChanges[] = {
    {"photo", [](HeadSurface& t) { Wear(t, 200, 20); }, [](HeadSurface& t) { Wear(t, 20, 200); }},
    {"strands", [](HeadSurface& t) { Comb(t, 1); }, [](HeadSurface& t) { Comb(t, 0); }},
    {"pbr_materials",
     [](HeadSurface& t) {
       Shine(t, {1, 0, 0});
     },
     [](HeadSurface& t) {
       Shine(t, {0, 0, 1});
     }},
    {"saturation",
     [](HeadSurface& t) {
       Wear(t, 120, 120);
       t.portrait.saturation = 1;
     },
     [](HeadSurface& t) {
       Wear(t, 120, 120);
       t.portrait.saturation = 0;
     }},
};

class ChangedHeadTest : public FrameTest, public ::testing::WithParamInterface<HeadChange> {
 protected:
  Image Drawn(Renderer& renderer, const Head& head) {
    Image image;
    renderer.DrawVertices(head, vertices_, state_.figure, scene_);
    renderer.Read(image);
    return image;
  }
};

TEST_P(ChangedHeadTest, IsNoticedWhereAnotherOneDied) {
  // Both live at the same address and have the same triangles and colours.
  const auto changed = [](void (*change)(HeadSurface&)) {
    return [change](HeadAsset& asset) { change(asset.surface); };
  };
  std::optional<BallHead> head(std::in_place, changed(GetParam().one));
  const Image one = Drawn(*renderer_, *head);
  head.emplace(changed(GetParam().other));
  const Image other = Drawn(*renderer_, *head);
  EXPECT_GT(Differing(one, other), 50);
  const auto fresh = Renderer::Make(*context_);
  EXPECT_EQ(Differing(other, Drawn(*fresh, *head)), 0);
}

INSTANTIATE_TEST_SUITE_P(EveryThingUploaded, ChangedHeadTest, ::testing::ValuesIn(kHeadChanges),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(HeadSerialTest, NoTwoHeadsHaveTheSameNotEvenTheOneMadeOfTheOther) {
  std::optional<BallHead> head(std::in_place);
  const std::uint64_t first = head->serial();
  EXPECT_EQ(head->serial(), first);
  const auto other = head->WithUnits(head->rig().data().units);
  EXPECT_NE(other->serial(), first);
  head.emplace();
  EXPECT_NE(head->serial(), first);
  EXPECT_NE(head->serial(), other->serial());
}

TEST_F(FrameTest, HeadWithoutEyesOrPartsIsDrawn) {
  const auto with_parts = [](std::size_t count) {
    return BallHead([count](HeadAsset& asset) { asset.surface.parts.resize(count); });
  };
  const BallHead bare = with_parts(1), nothing = with_parts(0);
  renderer_->DrawVertices(bare, vertices_, state_.figure, scene_);
  renderer_->DrawVertices(nothing, vertices_, state_.figure, scene_);
  Image image;
  renderer_->Read(image);
  EXPECT_EQ(At(image, kFrameWidth / 2, kFrameHeight / 2), kBackground);
}

TEST(PortraitTest, HeadAndShouldersStayInViewInEveryShape) {
  for (const auto& [width, height] :
       {std::pair{640, 480}, {480, 640}, {1920, 1080}, {256, 256}, {200, 600}}) {
    const FrameCamera view = ViewOfPortrait({}, Camera{}, width, height);
    for (const glm::vec3 point : {glm::vec3(0, 145, 0), {0, -160, 30}, {-95, 20, 0}, {95, 20, 0}}) {
      const glm::vec4 clip = view.world_to_clip * view.figure_to_world * glm::vec4(point, 1.0F);
      EXPECT_LT(std::abs(clip.x), clip.w) << width << " x " << height;
      EXPECT_LT(std::abs(clip.y), clip.w) << width << " x " << height;
    }
  }
}

TEST(PortraitTest, CameraMovesAsAsked) {
  const auto seen = [](const Camera& camera, const glm::vec3& point) {
    const FrameCamera view = ViewOfPortrait({}, camera, 640, 480);
    const glm::vec4 clip = view.world_to_clip * view.figure_to_world * glm::vec4(point, 1.0F);
    return glm::vec3(clip) / clip.w;
  };
  const glm::vec3 nose(0, 0, 120);
  const glm::vec3 cheek(50, 0, 50);
  EXPECT_NEAR(seen({.distance = 0.5F}, cheek).x, 2 * seen({}, cheek).x, 0.01F);
  EXPECT_LT(seen({.height_mm = 50}, nose).y, seen({}, nose).y - 0.1F);
  EXPECT_NEAR(seen({.field_degrees = 50}, cheek).x, seen({}, cheek).x, 0.01F) << "as large";
  EXPECT_LT(seen({.angle_degrees = 30}, nose).x, -0.1F) << "from the right the nose points left";
}

TEST(PortraitTest, RotationHasTheOriginalsSigns) {
  Figure figure;
  const glm::vec4 nose(0, 0, 120, 1);
  const auto moved = [&](std::size_t axis, const glm::vec4& point) {
    figure.rotation = {};
    figure.rotation[axis] = 20;
    return ViewOfPortrait(figure, Camera{}, 640, 480).figure_to_world * point - point;
  };
  EXPECT_LT(moved(0, nose).y, -10) << "x+ looks down";
  EXPECT_GT(moved(1, nose).x, 10) << "y+ looks to the viewer's right";
  EXPECT_GT(moved(2, {0, 120, 0, 1}).x, 10) << "z+ leans to the viewer's right";
}

TEST(ContextTest, PictureFollowsTheSizeOfTheContext) {
  const auto context = RenderContext::MakeHeadless(64, 64);
  auto renderer = Renderer::Make(*context);
  BallHead head;
  HeadVertices vertices;
  head.Evaluate({}, vertices);
  Image image;
  for (const auto& [width, height] : {std::pair{64, 64}, {200, 100}, {1, 1}, {200, 100}}) {
    context->Resize(width, height);
    renderer->DrawVertices(head, vertices, {}, {});
    renderer->Read(image);
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
  }
  const Pixel skin = At(image, 100, 50);
  EXPECT_GT(skin[0], skin[2]);
}

TEST(ContextTest, ImpossibleSizesAreRefusedWithASentence) {
  for (const auto& [width, height] : {std::pair{0, 10}, {10, -1}, {100000, 10}}) {
    EXPECT_THROW(RenderContext::MakeHeadless(width, height), std::runtime_error);
  }
}

TEST(ContextTest, WindowWithoutADisplayIsRefusedWithASentence) {
  const char* display = std::getenv("DISPLAY");
  const std::string kept = display ? display : "";
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  try {
    RenderContext::MakeWindow(64, 64, "test");
    ADD_FAILURE() << "a window without a display";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("window"), std::string::npos);
  }
  if (!kept.empty()) setenv("DISPLAY", kept.c_str(), 1);
}

TEST(ContextTest, SizesFromOnePixelUpAreDrawn) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 7}, {641, 479}}) {
    auto context = RenderContext::MakeHeadless(width, height);
    auto renderer = Renderer::Make(*context);
    BallHead head;
    HeadVertices vertices;
    head.Evaluate({}, vertices);
    renderer->DrawVertices(head, vertices, {}, {});
    Image image;
    renderer->Read(image);
    EXPECT_EQ(image.rgba.size(), static_cast<std::size_t>(width * height * 4));
  }
}

/// Two drivers may round a colour or the edge of a triangle differently: 1 pixel in 200 by more
/// than 4 of 255 is agreed to be the same picture.
TEST(ContextTest, OsMesaAndEglDrawTheSame) {
  std::unique_ptr<RenderContext> other;
  try {
    other = RenderContext::MakeHeadless(kFrameWidth, kFrameHeight, OffScreenDriver::kEgl);
  } catch (const std::runtime_error& error) {
    GTEST_SKIP() << "needs EGL (Debian: libegl1, libegl-dev): " << error.what();
  }
  BallHead head;
  HeadVertices vertices;
  head.Evaluate({}, vertices);
  Image pictures[2];
  auto other_renderer = Renderer::Make(*other);
  other_renderer->DrawVertices(head, vertices, {}, {});
  other_renderer->Read(pictures[0]);
  auto context = RenderContext::MakeHeadless(kFrameWidth, kFrameHeight);
  auto renderer = Renderer::Make(*context);
  renderer->DrawVertices(head, vertices, {}, {});
  renderer->Read(pictures[1]);
  int different = 0;
  for (std::size_t i = 0; i < pictures[0].rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t c = i; c < i + 4; ++c) {
      most = std::max(most, std::abs(pictures[0].rgba[c] - pictures[1].rgba[c]));
    }
    different += most > 4;
  }
  EXPECT_LE(different, kFrameWidth * kFrameHeight / 200);
  renderer.reset();
  context.reset();
  other->MakeCurrent();
  other_renderer.reset();
}

TEST(ContextTest, TwoContextsTakeTurns) {
  auto first = RenderContext::MakeHeadless(kFrameWidth, kFrameHeight);
  auto first_renderer = Renderer::Make(*first);
  auto second = RenderContext::MakeHeadless(kFrameHeight, kFrameWidth);
  auto second_renderer = Renderer::Make(*second);
  BallHead head;
  HeadVertices vertices;
  head.Evaluate({}, vertices);
  Image image;
  first->MakeCurrent();
  first_renderer->DrawVertices(head, vertices, {}, {});
  first_renderer->Read(image);
  const Image before = image;
  second->MakeCurrent();
  second_renderer->DrawVertices(head, vertices, {}, {});
  second_renderer->Read(image);
  EXPECT_EQ(image.width, kFrameHeight);
  second_renderer.reset();
  second.reset();
  first->MakeCurrent();
  first_renderer->DrawVertices(head, vertices, {}, {});
  first_renderer->Read(image);
  EXPECT_EQ(image.rgba, before.rgba);
}

/// Where a place of the figure comes out, -1..1 in both directions.
glm::vec2 Seen(const FrameCamera& view, glm::vec3 place) {
  const glm::vec4 clip = view.world_to_clip * view.figure_to_world * glm::vec4(place, 1);
  return glm::vec2(clip) / clip.w;
}

FrameCamera ParallelPortrait(const Figure& figure, int width, int height) {
  Camera camera;
  camera.moves_by_half_views = true;
  return ViewOfPortrait(figure, camera, width, height, ParallelView{{10, -20, 30}, 100});
}

void ExpectSeen(const FrameCamera& view, glm::vec3 place, glm::vec2 expected) {
  const glm::vec2 seen = Seen(view, place);
  EXPECT_NEAR(seen.x, expected.x, 1e-4F);
  EXPECT_NEAR(seen.y, expected.y, 1e-4F);
}

TEST(ParallelViewTest, ItsLongerSideFillsThePictureAtAnyDepth) {
  // As glOrtho in the original: of a picture that is wider than high top and bottom are cut.
  for (const float z : {-100.0F, 30.0F, 100.0F}) {
    ExpectSeen(ParallelPortrait({}, 200, 200), {110, 80, z}, {1, 1});
    ExpectSeen(ParallelPortrait({}, 200, 100), {110, 30, z}, {1, 1});
    ExpectSeen(ParallelPortrait({}, 100, 200), {60, 80, z}, {1, 1});
  }
  EXPECT_NEAR(ParallelPortrait({}, 200, 100).samples_per_mm, 2.0F, 1e-4F);
}

TEST(ParallelViewTest, ATranslationOfOneIsHalfTheLongerSide) {
  Figure figure;
  figure.translation = {1.0F, 0.2F};
  ExpectSeen(ParallelPortrait(figure, 200, 200), {10, -20, 30}, {1, 0.2F});
  ExpectSeen(ParallelPortrait(figure, 200, 100), {10, -20, 30}, {1, 0.4F});
  Camera portrait;
  portrait.moves_by_half_views = true;
  const glm::vec2 moved = Seen(ViewOfPortrait(figure, portrait, 300, 200), {0, -7, 50});
  EXPECT_NEAR(moved.x, 1, 1e-4F);
  EXPECT_NEAR(moved.y, 0.3F, 1e-4F);
}

TEST(ParallelViewTest, TheFigureTurnsByZThenYThenXAndGrowsAboutTheMiddle) {
  Figure figure;
  figure.scale = 0.5F;
  figure.rotation = {90, 0, 90};
  // z+ brings up to the viewer's right; then x+ would bring up to the viewer, which right is not.
  ExpectSeen(ParallelPortrait(figure, 200, 200), {10, 80, 30}, {0.5F, 0});
  ExpectSeen(ParallelPortrait(figure, 200, 200), {10, -20, 80}, {0, -0.25F});
}

}  // namespace
}  // namespace fsm
