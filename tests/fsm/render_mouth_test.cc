// The open mouth as a picture shows it, by places known on the head.

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <string_view>

#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"
#include "fsm/render/camera.h"
#include "fsm/render/mouth_finder.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

constexpr int kMouthSide = 600;

/// A head with some action units, drawn from near by.
class MouthPicture {
 public:
  MouthPicture(std::unique_ptr<Head> head, std::vector<std::pair<std::size_t, float>> units)
      : head_(std::move(head)) {
    FaceState state;
    for (const auto& [unit, strength] : units) {
      state.au.left[unit] = state.au.right[unit] = strength;
    }
    Scene scene;
    scene.camera = {.distance = 0.4F, .height_mm = -40};
    const auto context = RenderContext::MakeHeadless(kMouthSide, kMouthSide);
    const auto renderer = Renderer::Make(*context);
    head_->Evaluate(state, vertices_);
    renderer->DrawVertices(*head_, vertices_, state.figure, scene);
    renderer->Read(image_);
    const FrameCamera view = ViewOfPortrait(state.figure, scene.camera, kMouthSide, kMouthSide);
    to_clip_ = view.world_to_clip * view.figure_to_world;
  }

  /// Screen colours 0..255 at a place of the head's frame, the mean of 3 x 3 pixels.
  glm::vec3 At(glm::vec3 place) const {
    const glm::vec4 clip = to_clip_ * glm::vec4(place, 1);
    const int x = static_cast<int>((0.5F + 0.5F * clip.x / clip.w) * kMouthSide);
    const int y = static_cast<int>((0.5F - 0.5F * clip.y / clip.w) * kMouthSide);
    EXPECT_TRUE(x > 0 && x < kMouthSide - 1 && y > 0 && y < kMouthSide - 1)
        << "the mouth is in the picture";
    glm::vec3 sum(0);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const auto i = static_cast<std::size_t>((y + dy) * kMouthSide + x + dx) * 4;
        sum += glm::vec3(image_.rgba[i], image_.rgba[i + 1], image_.rgba[i + 2]);
      }
    }
    return sum / 9.0F;
  }
  float Light(glm::vec3 place) const { return glm::dot(At(place), glm::vec3(0.3F, 0.6F, 0.1F)); }

  glm::vec3 Vertex(std::uint32_t i) const { return vertices_.position[i]; }
  const MouthVertices& mouth() const { return head_->mouth(); }
  /// The upper or the lower lip's edge at one x.
  glm::vec3 Lip(bool upper, float x) const {
    glm::vec3 best(1e6F);
    for (const auto& [above, below] : mouth().seam) {
      const glm::vec3 p = Vertex(upper ? above : below);
      if (std::abs(p.x - x) < std::abs(best.x - x)) best = p;
    }
    return best;
  }

 private:
  std::unique_ptr<Head> head_;
  HeadVertices vertices_;
  Image image_;
  glm::mat4 to_clip_{1.0F};
};

constexpr float kIncisor = 4;  // its middle, millimetres from the median

constexpr glm::vec3 kPhoto(200, 150, 130);

/// A photo of one colour.
PhotoHead OneColour() {
  PhotoHead set;
  for (const glm::vec3 at : {glm::vec3(-60, 0, 0), glm::vec3(60, 0, 0), glm::vec3(0, 60, 60),
                             glm::vec3(0, -80, 60), glm::vec3(0, 0, 90)}) {
    set.points.push_back({at, glm::vec3(0)});
  }
  auto photo = std::make_shared<Image>(Image{8, 8, {}});
  for (int i = 0; i < 64; ++i) {
    for (int c = 0; c < 3; ++c) photo->rgba.push_back(static_cast<std::uint8_t>(kPhoto[c]));
    photo->rgba.push_back(255);
  }
  set.atlas = photo;
  set.lip_colour = 0.5F * (kPhoto / 255.0F) * (kPhoto / 255.0F);
  return set;
}

/// The base head in it.
std::unique_ptr<Head> InPhoto() { return MakeHead(OneColour()); }

/// With a neck: a sheet behind the chin.
std::unique_ptr<Head> WithNeck() {
  PhotoHead set = OneColour();
  set.skin_bottom_y = -86;
  constexpr std::uint32_t kColumns = 13;
  for (std::uint32_t i = 0; i < kColumns * kColumns; ++i) {
    const auto column = static_cast<float>(i % kColumns), row = static_cast<float>(i / kColumns);
    set.sheet.push_back({{-60 + 10 * column, -60 - 10 * row, 20}, {0.5F, 0.5F}});
    if (i % kColumns == 0 || i < kColumns) continue;
    const std::uint32_t left = i - 1, above = i - kColumns;
    for (const std::uint32_t v : {above - 1, left, i, above - 1, i, above}) {
      set.sheet_triangles.push_back(v);
    }
  }
  return MakeHead(set);
}

TEST(MouthPictureTest, UpperTeethAreDarkestUnderTheLip) {
  const MouthPicture picture(InPhoto(), {{10, 1.0F}, {26, 0.5F}, {25, 1.0F}});
  const glm::vec3 lip = picture.Lip(true, kIncisor);
  const float edge = picture.Vertex(picture.mouth().incisors->upper).y;
  ASSERT_GT(lip.y - edge, 2.5F) << "enough of the tooth is seen";
  const float z = picture.Vertex(picture.mouth().incisors->upper).z;
  const auto at = [&](float part) {
    return picture.Light({kIncisor, glm::mix(lip.y, edge, part), z});
  };
  EXPECT_LT(at(0.15F), 0.93F * at(0.55F));
}

TEST(MouthPictureTest, TeethStandInTheHueThatTheWhitesOfTheEyesShow) {
  const auto tooth = [](glm::vec3 white) {
    PhotoHead set = OneColour();
    set.white_colour = white;
    const MouthPicture picture(MakeHead(set), {{10, 1.0F}, {26, 0.5F}, {25, 1.0F}});
    const glm::vec3 edge = picture.Vertex(picture.mouth().incisors->upper);
    return picture.At(
        glm::mix(picture.Lip(true, kIncisor), glm::vec3(kIncisor, edge.y, edge.z), 0.6F));
  };
  const glm::vec3 plain = tooth(glm::vec3(0.5F)), warm = tooth({0.5F, 0.35F, 0.25F});
  EXPECT_GT(warm.r / warm.b, 1.06F * plain.r / plain.b);
  EXPECT_NEAR(warm.r, plain.r, 4) << "no darker in what the light has most of";
}

TEST(MouthPictureTest, MoreOfTheUpperTeethIsSeenOfAFaceFromAPhoto) {
  const auto below_lip = [](std::unique_ptr<Head> head) {
    const MouthPicture picture(std::move(head), {});
    return picture.Lip(true, 0).y - picture.Vertex(picture.mouth().incisors->upper).y;
  };
  const float built_in = below_lip(MakeHead("galatea"));
  EXPECT_GT(below_lip(InPhoto()) - built_in, 0.3F);
}

TEST(MouthPictureTest, TongueSinksIntoTheDarkToItsSides) {
  const MouthPicture picture(InPhoto(), {{27, 0.8F}});
  const glm::vec3 teeth = picture.Vertex(picture.mouth().incisors->lower);
  const auto at = [&](float x) { return picture.Light({x, teeth.y + 4, teeth.z - 12}); };
  EXPECT_GT(at(0), 45) << "it is lit in the middle";
  for (const float side : {-1.0F, 1.0F}) {
    EXPECT_LT(at(side * 12), 0.85F * at(side * 4)) << side;
    EXPECT_LT(at(side * 12) - at(side * 14), 0.4F * at(0)) << side << ": no edge there";
  }
}

TEST(MouthPictureTest, FleshClosesTheCornersOfAnOpenMouth) {
  const MouthPicture picture(InPhoto(), {{25, 0.6F}, {26, 1.0F}});
  for (const float side : {-1.0F, 1.0F}) {
    // From the side inward: where the lips are first apart.
    float x = 26;
    const auto gap = [&] { return picture.Lip(true, side * x).y - picture.Lip(false, side * x).y; };
    while (x > 0 && gap() < 3) x -= 0.25F;
    const auto between = [&](float at) {
      const glm::vec3 upper = picture.Lip(true, side * at), lower = picture.Lip(false, side * at);
      return picture.At({side * at, 0.5F * (upper.y + lower.y), upper.z});
    };
    const glm::vec3 corner = between(x + 0.25F), inside = between(x - 5);
    EXPECT_GT(corner.r, 1.4F * inside.r) << side;
    EXPECT_GT(inside.r, 0.18F * kPhoto.r) << side << ": there is light within";
    EXPECT_GT(corner.r, 1.3F * corner.g) << side << ": it is red";
    EXPECT_LT(corner.r, 0.8F * kPhoto.r) << side;
  }
}

TEST(MouthPictureTest, AMouthThatIsHardlyOpenIsDarkRedAndNotBlack) {
  const MouthPicture picture(InPhoto(), {{25, 0.9F}, {18, 0.6F}});
  const glm::vec3 upper = picture.Lip(true, 9), lower = picture.Lip(false, 9);
  ASSERT_GT(upper.y - lower.y, 1);
  const glm::vec3 seen = picture.At(glm::mix(lower, upper, 0.3F) - glm::vec3(0, 0, 1));
  EXPECT_GT(seen.r, 0.4F * kPhoto.r);
  EXPECT_GT(seen.r, 1.4F * seen.g);
  EXPECT_LT(seen.r, 0.65F * kPhoto.r);
}

TEST(MouthPictureTest, PhotoLipsRollInwardThroughADarkerRedderBand) {
  const MouthPicture picture(InPhoto(), {{26, 0.6F}, {25, 0.5F}});
  for (const bool upper : {true, false}) {
    const glm::vec3 lip = picture.Lip(upper, kIncisor);
    const float out = upper ? 1.0F : -1.0F;
    const glm::vec3 outside = picture.At(lip + glm::vec3(0, 4 * out, 0));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(outside[c], kPhoto[c], 12) << "the photo's own colour";
    const glm::vec3 edge = picture.At(lip + glm::vec3(0, 0.2F * out, 0));
    EXPECT_LT(edge.g, 0.92F * outside.g);
    EXPECT_GT(edge.g, 0.35F * outside.g) << "which is no cut into the dark";
    EXPECT_GT(edge.r / edge.g, 1.02F * outside.r / outside.g);
  }
}

TEST(MouthPictureTest, ClosedPhotoLipsMeetAsThePhotoShowsThem) {
  const MouthPicture picture(InPhoto(), {});
  for (const float x : {0.0F, 10.0F, -20.0F}) {
    const glm::vec3 lip = picture.Lip(false, x);
    for (float mm = -1.5F; mm < 1.6F; mm += 0.5F) {
      const glm::vec3 seen = picture.At(lip + glm::vec3(0, mm, 0));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], kPhoto[c], 4) << x << ' ' << mm;
    }
  }
}

TEST(MouthPictureTest, ADroppedChinThrowsAShadowOnTheNeckOfAPhoto) {
  const auto neck = [](float jaw) {
    return MouthPicture(WithNeck(), {{26, jaw}}).Light({8, -104, 20});
  };
  const float at_rest = neck(0);
  EXPECT_NEAR(at_rest, glm::dot(kPhoto, glm::vec3(0.3F, 0.6F, 0.1F)), 3) << "as the photo has it";
  EXPECT_LT(neck(0.5F), 0.93F * at_rest);
  EXPECT_GT(neck(0.5F), 0.65F * at_rest);
}

TEST(MouthPictureTest, TheChinsShadowDoesNotReachBeyondTheNeck) {
  for (float y = -64; y > -100; y -= 4) {
    const auto beside = [y](float jaw) {
      return MouthPicture(WithNeck(), {{26, jaw}}).Light({-58, y, 20});
    };
    EXPECT_NEAR(beside(0.8F), beside(0), 6) << y;
  }
}

/// A photo with a neck that does not say where its lips part, as heads from elsewhere may not.
Head WithoutMouth() {
  const auto head = WithNeck();
  HeadAsset asset{.surface = head->surface(),
                  .rig = head->rig().data(),
                  .landmarks = head->landmarks(),
                  .view = head->view()};
  asset.rig.mouth.incisors.reset();
  return Head(std::move(asset));
}

TEST(MouthPictureTest, AHeadThatSaysNothingOfItsLipsTakesNothingFromTheOneDrawnBefore) {
  const Head second = WithoutMouth();
  const auto first = WithNeck();
  Scene scene;
  scene.camera = {.distance = 0.4F, .height_mm = -40};
  const auto drawn = [&](const Head* before) {
    const auto context = RenderContext::MakeHeadless(kMouthSide, kMouthSide);
    const auto renderer = Renderer::Make(*context);
    HeadVertices vertices;
    if (before) {
      FaceState open;
      open.au.left[26] = open.au.right[26] = 1;
      before->Evaluate(open, vertices);
      renderer->DrawVertices(*before, vertices, open.figure, scene);
    }
    second.Evaluate({}, vertices);
    renderer->DrawVertices(second, vertices, {}, scene);
    Image image;
    renderer->Read(image);
    return image.rgba;
  };
  const auto alone = drawn(nullptr), after = drawn(first.get());
  int other = 0;
  for (std::size_t i = 0; i < alone.size(); ++i) other += alone[i] != after[i] ? 1 : 0;
  EXPECT_EQ(other, 0) << "bytes of the picture";
}

TEST(MouthFinderTest, LipsAreShutWhereNothingIsSeenBetweenThem) {
  const auto head = MakeHead("galatea");
  const MouthFinder finder(head->mouth());
  HeadVertices vertices;
  head->Evaluate({}, vertices);
  EXPECT_TRUE(finder.Measure(vertices)->IsShut());
  for (const glm::vec3 apart :
       {glm::vec3(0, 0.5F, 0), glm::vec3(0, 0, 0.5F), glm::vec3(0, 0, -0.5F)}) {
    HeadVertices open = vertices;
    for (const auto& pair : head->mouth().seam) open.position[pair.first] += apart;
    EXPECT_FALSE(finder.Measure(open)->IsShut()) << apart.y << " " << apart.z;
  }
  FaceState state;
  state.au.left[25] = state.au.right[25] = 0.2F;
  head->Evaluate(state, vertices);
  EXPECT_FALSE(finder.Measure(vertices)->IsShut());
}

}  // namespace
}  // namespace fsm
