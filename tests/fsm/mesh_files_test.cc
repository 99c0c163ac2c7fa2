#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "fsm/mesh/obj/obj_file.h"
#include "fsm/mesh/original/original_face.h"
#include "fsm/mesh/original/pnt_file.h"

namespace fsm {
namespace {

TEST(PntFileTest, PlacesAreFoundByGroupAndNumberWhateverEndsTheLines) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const auto file =
        ParsePnt("f.pnt", "#3" + end + "  1   4  17  0.5 -1 2e-1" + end + "2 4 18 0 0 0" + end);
    ASSERT_TRUE(file) << file.error().text;
    ASSERT_EQ(file->positions.size(), 2U);
    EXPECT_EQ(file->positions[file->index.at({4, 17})], glm::vec3(0.5F, -1, 0.2F));
  }
}

struct Damage {
  std::string text, words;
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << '"' << damage.text << '"'; }

class DamagedPntTest : public testing::TestWithParam<Damage> {};

TEST_P(DamagedPntTest, IsRefusedWithItsPlace) {
  const auto file = ParsePnt("f.pnt", GetParam().text);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().text.find("f.pnt"), std::string::npos) << file.error().text;
  EXPECT_NE(file.error().text.find(GetParam().words), std::string::npos) << file.error().text;
}

INSTANTIATE_TEST_SUITE_P(
    All, DamagedPntTest,
    testing::Values(Damage{"", "f.pnt:1: #N expected"}, Damage{"836\n", "f.pnt:1: #N expected"},
                    Damage{"#-4\n", "#N expected"}, Damage{"#999999999\n", "at most 20000"},
                    Damage{"#3\n1 1 1 0 0 0\n", "it ends after 1 of 2 points"},
                    Damage{"#2\n1 1 1 0 0\n", "f.pnt:2: INDEX GROUP NUMBER X Y Z"},
                    Damage{"#2\n1 1 1 0 zero 0\n", "'1 1 1 0 zero 0'"},
                    Damage{"#2\n1 1 1 0 nan 0\n", "f.pnt:2"},
                    Damage{"#2\n1 1 1 0 1e30 0\n", "f.pnt:2"},
                    Damage{"#2\n1 0 1 0 0 0\n", "f.pnt:2"},
                    Damage{"#3\n1 1 1 0 0 0\n2 1 1 0 0 0\n", "f.pnt:3: point 1 of group 1"},
                    Damage{"#2\n1 1 1 0 0 0\n2 1 2 0 0 0\n", "announces 1 points"},
                    Damage{std::string("#2\n1 1 1 0 \x01\x02 0\n"), "f.pnt:2"}));

class DamagedLnkTest : public testing::TestWithParam<Damage> {};

TEST_P(DamagedLnkTest, IsRefusedWithItsPlace) {
  const auto file = ParseLnk("f.lnk", GetParam().text);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().text.find(GetParam().words), std::string::npos) << file.error().text;
}

INSTANTIATE_TEST_SUITE_P(
    All, DamagedLnkTest,
    testing::Values(Damage{"#2\n1 1 1 1 1 1 2 1\n", "f.lnk:2: INDEX GROUP NUMBER"},
                    Damage{"#3\n1 1 1 1 1 1 2 1 3\n", "it ends after 1 of 2 triangles"},
                    Damage{"#2\n1 1 1 1 1 1 -2 1 3\n", "f.lnk:2"},
                    Damage{"#2\n1 1 1 1 1 1 2 1 3\n\n1 1 1 1 1 1 2 1 3\n",
                           "f.lnk:4: the header announces 1"}));

TEST(LnkFileTest, CornersAreNames) {
  const auto file = ParseLnk("f.lnk", "#2\n1 31 72 31 37 19 12 31 39\n");
  ASSERT_TRUE(file) << file.error().text;
  EXPECT_EQ(file->triangles[0].group, 31);
  EXPECT_EQ(file->triangles[0].corner[1], PointName(19, 12));
}

std::string Doubles(std::array<double, 29> values) {
  std::string bytes;
  for (const double v : values) {
    const auto bits = std::bit_cast<std::uint64_t>(v);
    for (int k = 0; k < 8; ++k) bytes += static_cast<char>(bits >> (8 * k));
  }
  return bytes;
}

TEST(EyeDefTest, TwentyNineDoublesSayWhereBothEyesAre) {
  std::array<double, 29> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  const auto def = ParseEyeDef("a.def_e", Doubles(values));
  ASSERT_TRUE(def) << def.error().text;
  EXPECT_EQ(def->eye.left.position, glm::vec3(7, 8, 9));
  EXPECT_EQ(def->eye.left.scale, 13);
  EXPECT_EQ(def->eye.right.rotation_degrees, glm::vec3(17, 18, 19));
  EXPECT_EQ(def->eye.left.rotation_degrees, glm::vec3(24, 25, 26));
  EXPECT_EQ(def->picture_scale, 28);
}

TEST(EyeDefTest, NumbersTheOriginalNeverDrawsByMayBeAnything) {
  // man01_eye.def_e has -6e66 in byte 216, the scale of the left eye within its ball.
  for (const std::size_t unused : {3U, 5U, 10U, 12U, 14U, 16U, 20U, 21U, 23U, 27U}) {
    std::array<double, 29> values{};
    values[unused] = -6e66;
    const auto def = ParseEyeDef("a.def_e", Doubles(values));
    EXPECT_TRUE(def) << unused << ": " << def.error().text;
  }
  for (const std::size_t used : {0U, 6U, 9U, 13U, 17U, 26U, 28U}) {
    std::array<double, 29> values{};
    values[used] = 1e277;
    EXPECT_FALSE(ParseEyeDef("a.def_e", Doubles(values))) << used;
  }
}

TEST(EyeDefTest, ShortFilesAndNumbersThatAreNoneAreRefusedWithTheByte) {
  std::array<double, 29> values{};
  const auto whole = Doubles(values);
  const auto cut = ParseEyeDef("a.def_e", std::string_view(whole).substr(0, 231));
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().text.find("a.def_e: byte 231"), std::string::npos) << cut.error().text;
  values[2] = std::numeric_limits<double>::quiet_NaN();
  const auto none = ParseEyeDef("a.def_e", Doubles(values));
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text.find("byte 16"), std::string::npos) << none.error().text;
}

TEST(TeethDefTest, ThreeNumbersAreAColour) {
  EXPECT_EQ(ParseTeethDef("t", "0.5 0.25 1\n").value(), glm::vec3(0.5F, 0.25F, 1));
  for (const char* text : {"", "0.5 0.5", "0.5 0.5 7", "red"})
    EXPECT_FALSE(ParseTeethDef("t", text));
}

TEST(ObjFileTest, PolygonsBecomeTrianglesByGroup) {
  const auto file =
      ParseObj("h.obj",
               "# a head\nmtllib h.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.5 1\n"
               "g face\nf 1/1 2/1 3/1 4/1\ng eye\nusemtl blue\nf -1//2 -2//2 -3//2\n");
  ASSERT_TRUE(file) << file.error().text;
  ASSERT_EQ(file->groups.size(), 2U);
  EXPECT_EQ(file->groups[0].triangles.size(), 2U);
  EXPECT_EQ(file->groups[0].triangles[1][2].texcoord, 0U);
  EXPECT_EQ(file->groups[1].material, "blue");
  EXPECT_EQ(file->groups[1].triangles[0][0].position, 3U);
  EXPECT_EQ(file->groups[1].triangles[0][0].texcoord, ObjFile::kNone);
  EXPECT_EQ(file->libraries, std::vector<std::string>{"h.mtl"});
}

class DamagedObjTest : public testing::TestWithParam<Damage> {};

TEST_P(DamagedObjTest, IsRefusedWithItsPlace) {
  const auto file = ParseObj("h.obj", GetParam().text);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().text.find(GetParam().words), std::string::npos) << file.error().text;
}

INSTANTIATE_TEST_SUITE_P(
    All, DamagedObjTest,
    testing::Values(Damage{"", "no faces"}, Damage{"v 0 0 0\n", "no faces"},
                    Damage{"v 0 0\n", "h.obj:1: v X Y Z"}, Damage{"v 0 0 inf\n", "h.obj:1"},
                    Damage{"v 0 0 0\nf 1 1\n", "h.obj:2: f with 3"},
                    Damage{"v 0 0 0\nf 1 1 2\n", "h.obj:2: corner '2' names none of the 1"},
                    Damage{"v 0 0 0\nf 1 1 -2\n", "corner '-2'"},
                    Damage{"v 0 0 0\nf 1 1 x\n", "corner 'x'"}));

TEST(ObjFileTest, FacesOfZerosJoinNothing) {
  const auto file =
      ParseObj("teeth.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/1 2/2 3/3\nf 0/0 0/0 0/0\n");
  ASSERT_TRUE(file) << file.error().text;
  EXPECT_EQ(file->groups[0].triangles.size(), 1U);
}

}  // namespace
}  // namespace fsm
