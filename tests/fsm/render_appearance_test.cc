// The table that says how things look.

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "fsm/base/parse_number.h"
#include "fsm/head/make_head.h"
#include "fsm/render/appearance.h"
#include "fsm/render/renderer.h"
#include "fsm/render/skin_texture.h"
#include "tests/fsm/ball_head.h"
#include "tests/fsm/golden_picture.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

std::string BuiltInText() {
  const auto bytes = FileBytes(GALATEA_SOURCE_DIR "/fsm/render/tables/appearance.txt");
  return {bytes.begin(), bytes.end()};
}

/// The built-in table with the first `old_text` in it replaced.
std::string Changed(const std::string& old_text, const std::string& new_text) {
  std::string text = BuiltInText();
  const auto at = text.find(old_text);
  EXPECT_NE(at, std::string::npos) << old_text;
  return text.replace(at, old_text.size(), new_text);
}

/// The built-in row that begins so.
std::string Row(const std::string& key) {
  const std::string text = BuiltInText();
  const auto at = text.find("\n" + key) + 1;
  return text.substr(at, text.find('\n', at) - at);
}

int LineOf(const std::string& word) {
  const std::string text = BuiltInText();
  const auto before = text.substr(0, text.find(word));
  return 1 + static_cast<int>(std::ranges::count(before, '\n'));
}

std::string Refusal(const std::string& text) {
  try {
    Appearance("mine/appearance.txt", text);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(AppearanceTest, BadRowsAreRefusedWithFileAndLine) {
  struct Case {
    std::string row, instead, why;
  };
  const Case cases[] = {
      {"\nexposure            0.44", "\nexposure bright", "'exposure bright' is not known"},
      {"\nexposure            0.44", "\nexposure", "'exposure' needs 1 numbers after it, found 0"},
      {"\nexposure            0.44", "\nexposure 0.4 0.5", "'exposure' needs 1 numbers"},
      {"\nexposure            0.44", "\nexposure 1 nan", "'nan' found where a number"},
      {"\nexposure            0.44", "\nexposure 1e9",
       "'1e9' found where -1000 to 1000 was expected"},
      {"\nexposure            0.44", "\nexposures 0.44", "'exposures' is not known"},
      {"\nexposure            0.44", "\nsky_colour 1 1 1", "'sky_colour' is there twice"},
      {"\n" + Row("wrap skin"), "\nwrap wood 1 2 3",
       "'wrap wood' is not known; known are wrap cloth, wrap gums"},
      {"\n" + Row("wrap skin"), "\nwrap skin 0.6 0.4", "'wrap skin' needs 3 numbers"},
      {"\n" + Row("lamp key direction"), "\nlamp key direction 0 0 0",
       "a lamp that stands nowhere"},
      {"\n" + Row("skin pore dark"), "\nskin pore dark 1", "'skin pore dark' needs 2 numbers"},
      {"\n" + Row("skin moles one_in"), "\nskin moles one_in 100000",
       "'100000' found where -1000 to 1000 was expected"},
  };
  for (const Case& one : cases) {
    const std::string refused = Refusal(Changed(one.row, one.instead));
    const std::string where = "mine/appearance.txt:" + std::to_string(LineOf(one.row.substr(1)));
    EXPECT_TRUE(refused.starts_with(where + ": ")) << refused << "\n" << one.instead;
    EXPECT_NE(refused.find(one.why), std::string::npos) << refused;
  }
}

TEST(AppearanceTest, NumbersReachSurfacesAndShaders) {
  const Appearance mine("mine", "wrap cloth 0.75 0.25 0.25\nexposure 0.5\nsky_colour 0.25 0.5 1\n");
  EXPECT_EQ(mine.surface(Material::kCloth).wrap, glm::vec3(0.75F, 0.25F, 0.25F));
  EXPECT_EQ(Appearance::BuiltIn().surface(Material::kCloth).wrap, glm::vec3(0.25F));
  EXPECT_NE(mine.constants().find("const vec3 look_sky_colour = vec3(0.25, 0.5, 1);\n"),
            std::string::npos);
  EXPECT_NE(mine.constants().find("const float look_exposure = float(0.5);\n"), std::string::npos);
}

TEST(AppearanceTest, ATableOfOnesOwnChangesThePicture) {
  const auto context = RenderContext::MakeHeadless(64, 64);
  const BallHead head;
  HeadVertices vertices;
  head.Evaluate({}, vertices);
  const auto brightness = [&](const Appearance& appearance) {
    const auto renderer = Renderer::Make(*context, 1, appearance);
    renderer->DrawVertices(head, vertices, {}, {});
    Image image;
    renderer->Read(image);
    long sum = 0;
    for (const std::uint8_t byte : image.rgba) sum += byte;
    return sum;
  };
  const long usual = brightness(Appearance::BuiltIn());
  EXPECT_EQ(brightness(Appearance("same", BuiltInText())), usual);
  const Appearance dark("dark", Changed("\nexposure            0.44", "\nexposure 0.2"));
  EXPECT_LT(brightness(dark), usual);
  const Appearance unlit("unlit", Changed(Row("lamp key light"), "lamp key light 0 0 0"));
  EXPECT_LT(brightness(unlit), usual);
}

TEST(AppearanceTest, TheSkinIsPaintedAsItsRowsSay) {
  const auto head = MakeHead("galatea");
  HeadVertices rest;
  head->Evaluate({}, rest);
  const auto landmarks = FaceLandmarks::Find(*head);
  ASSERT_TRUE(landmarks);
  const auto painted = [&](const std::string& row, const std::string& instead) {
    const Appearance mine("mine", row.empty() ? BuiltInText() : Changed(row, instead));
    return PaintSkin(head->surface(), rest, *landmarks, mine);
  };
  const SkinTexture usual = painted("", "");
  const auto differing = [](const Image& a, const Image& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) count += a.rgba[i] != b.rgba[i] ? 1 : 0;
    return count;
  };
  const SkinTexture plain = painted(Row("skin freckles hundreds"), "skin freckles hundreds 0");
  EXPECT_GT(differing(plain.tint, usual.tint), 1000U);
  EXPECT_EQ(plain.relief.rgba, usual.relief.rgba);
  const SkinTexture smooth =
      painted(Row("skin forehead_lines depth"), "skin forehead_lines depth 0");
  EXPECT_EQ(smooth.tint.rgba, usual.tint.rgba);
  EXPECT_GT(differing(smooth.relief, usual.relief), 1000U);
}

TEST(AppearanceTest, ASkinOfZerosAndOfExtremesIsPaintedAllTheSame) {
  const auto head = MakeHead("galatea");
  HeadVertices rest;
  head->Evaluate({}, rest);
  const auto landmarks = FaceLandmarks::Find(*head);
  ASSERT_TRUE(landmarks);
  const Table built_in("built-in", BuiltInText());
  for (const std::string number : {"0", "-1000", "0.001"}) {
    std::string text;
    for (const TableRow& row : built_in.rows()) {
      const bool skin = row.key() == "skin";
      for (std::size_t i = 0; i < row.size(); ++i) {
        const bool replaced = skin && i >= 3 && ParseNumber<float>(row.Word(i));
        text += (i == 0 ? "" : " ") + (replaced ? number : row.Word(i));
      }
      text += "\n";
    }
    const Appearance mine("mine", text);
    EXPECT_EQ(PaintSkin(head->surface(), rest, *landmarks, mine).tint.width, SkinTexture::kSide);
  }
}

TEST(AppearanceTest, PoresAreLeftOutOnlyWhereTheyAreNotSeen) {
  const auto head = MakeHead("galatea");
  const auto context = RenderContext::MakeHeadless(256, 256);
  const Appearance always("always", Changed("\npores_from          2.0", "\npores_from 0"));
  const Appearance never("never", Changed("\npores_from          2.0", "\npores_from 10"));
  Scene scene;
  const auto drawn = [&](const Appearance& appearance) {
    const auto renderer = Renderer::Make(*context, 1, appearance);
    renderer->Draw(*head, FaceState{}, {}, scene);
    Image image;
    renderer->Read(image);
    return image;
  };
  const auto missed = [&](const Appearance& appearance) {
    return CompareFigures(drawn(always), drawn(appearance), kPlainBackground).mean;
  };
  const double far = missed(Appearance::BuiltIn());
  EXPECT_GT(far, 0);
  EXPECT_LT(far, GoldenLimits{}.mean);
  scene.camera.distance = 0.4F;
  EXPECT_EQ(missed(Appearance::BuiltIn()), 0);
  EXPECT_GT(missed(never), GoldenLimits{}.mean);
}

}  // namespace
}  // namespace fsm
