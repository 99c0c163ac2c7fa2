#include "fsm/head/identity.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "face_editor/core/editor.h"
#include "face_editor/core/face_name.h"
#include "face_editor/core/identity_head.h"
#include "fsm/faces/face_folder.h"
#include "fsm/head/make_head.h"

namespace editor {
namespace {

TEST(FaceNameTest, IsThatOfThePhotosFileMadeAValidOne) {
  const std::pair<const char*, const char*> cases[] = {
      {"me.jpg", "me"},
      {"/home/x/Anna Maria (2).png", "Anna_Maria_2"},
      {"写真.jpg", "face"},
      {"", "face"},
      {"a.b-c_d.jpeg", "a_b-c_d"}};
  for (const auto& [photo, name] : cases) {
    EXPECT_EQ(FaceNameOf(photo), name) << photo;
    EXPECT_TRUE(fsm::IsFaceName(FaceNameOf(photo))) << photo;
  }
  EXPECT_TRUE(fsm::IsFaceName(FaceNameOf(std::string(300, 'x') + ".png")));
}

TEST(IdentityTest, ASliderMovesWhatItIsCalledAfter) {
  const auto plain = MakeIdentityHead("galatea", SlidersOf("galatea"));
  auto sliders = SlidersOf("galatea");
  sliders["nose_length"] = 2;
  const auto longer = MakeIdentityHead("galatea", sliders);
  ASSERT_TRUE(plain && longer);
  EXPECT_LT((*longer)->Landmark("pronasale").y, (*plain)->Landmark("pronasale").y - 3);
  EXPECT_NEAR((*longer)->Landmark("gnathion").y, (*plain)->Landmark("gnathion").y, 0.5F);
  const auto unchanged = fsm::MakeHead("galatea");
  EXPECT_EQ(unchanged->Landmark("pronasale"), (*plain)->Landmark("pronasale"));
}

TEST(IdentityTest, WhatIsSavedIsWornAndReadAgain) {
  std::string folder = testing::TempDir() + "/identity_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  auto editor = *Editor::Make("");
  ASSERT_TRUE(editor->SetBase("pygmalion"));
  ASSERT_TRUE(editor->SetSlider("jaw_width", -1.25F));
  const auto place = editor->SaveIdentity("berta", folder);
  ASSERT_TRUE(place) << place.error().text;
  EXPECT_FALSE(editor->Unsaved(Part::kIdentity));
  std::ofstream(*place + "/identity.txt", std::ios::app) << "colour hair 0.5 0.4 0.1\n";

  auto other = *Editor::Make("");
  ASSERT_TRUE(other->LoadIdentity("berta", folder));
  EXPECT_EQ(other->state().base, "pygmalion");
  EXPECT_EQ(other->state().sliders, editor->state().sliders);
  ASSERT_TRUE(other->SaveIdentity("cora", folder));
  std::ifstream file(folder + "/cora/identity.txt");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_NE(text.find("colour hair 0.5 0.4 0.1"), std::string::npos) << "not edited, not lost";
  const auto identity = fsm::ReadOwnIdentity("cora", text);
  EXPECT_EQ(identity.palette.hair, glm::vec3(0.5F, 0.4F, 0.1F));
  std::filesystem::remove_all(folder);
}

TEST(IdentityTest, DamageIsToldWithItsLine) {
  for (const auto& [text, part] :
       {std::pair("slider jaw_width 1\n", "f:1: 'base FACE' expected"),
        std::pair("base nobody\n", "f:1: no built-in face is called nobody"),
        std::pair("base galatea\nslider ear_hair 1\n", "f:2: no slider is called ear_hair"),
        std::pair("base galatea\nslider jaw_width 11\n", "f:2: '11' found where -10 to 10"),
        std::pair("base galatea\nbeard 300\n", "f:2: '300' found where 0 to 1"),
        std::pair("base galatea\nlashes -1\n", "f:2: '-1' found where 0 to 2"),
        std::pair("base galatea\ncolour skin 0.5 255 0.5\n", "f:2: '255' found where 0 to 1"),
        std::pair("base galatea\nhair crop 5 1e9 0 5 0.8 2.5 0 3\n", "f:2: '1e9' found where"),
        std::pair("base galatea\nbrows 1 90\n", "f:2: '90' found where -8 to 8"),
        std::pair("base galatea\ncreases 0 0 7 0\n", "f:2: '7' found where 0 to 1"),
        std::pair("base galatea\nslider jaw_width\n", "f:2:"),
        std::pair("base galatea\nbase galatea\n", "f:2: a second base"),
        std::pair("base galatea\nnose long\n", "f:2: unknown word"), std::pair("", "no line")}) {
    const auto face = ReadOwnFace("f", text);
    ASSERT_FALSE(face) << text;
    EXPECT_NE(face.error().text.find(part), std::string::npos) << face.error().text;
  }
}

TEST(IdentityTest, FacesOfPhotosAreNotWrittenOver) {
  std::string folder = testing::TempDir() + "/identity_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  std::filesystem::create_directory(folder + "/anna");
  std::ofstream(folder + "/anna/face.txt") << "base galatea\n";
  auto editor = *Editor::Make("");
  EXPECT_FALSE(editor->SaveIdentity("anna", folder));
  EXPECT_FALSE(editor->SaveIdentity("../anna", folder));
  EXPECT_FALSE(editor->SetBase("nobody"));
  EXPECT_FALSE(editor->SetSlider("ear_hair", 1));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace editor
