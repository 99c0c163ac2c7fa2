#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <string>

#include "fsm/base/table_reader.h"
#include "fsm/head/anatomy.h"
#include "fsm/head/cage.h"
#include "fsm/head/features.h"
#include "fsm/head/identity.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/make_head.h"
#include "fsm/rig/unit_combiner.h"

namespace fsm {
namespace {

template <typename F>
std::string Complaint(F&& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no complaint";
}

/// A face made of a built-in one; its rows begin at the second line of "i.txt".
Identity Changed(const std::string& face, std::initializer_list<const char*> rows) {
  std::string text = "base " + face + "\n";
  for (const char* row : rows) text += row + std::string("\n");
  return ReadOwnIdentity("i.txt", text);
}

TEST(HeadTablesTest, CommentsAndBlankLinesAreSkipped) {
  const Table table("t.txt", "# all comment\n\n  key 1 +2.5 -3 # rest\r\nkey\nh# #1\n");
  ASSERT_EQ(table.rows().size(), 3u);
  EXPECT_EQ(table.rows()[0].Vector(1), glm::vec3(1, 2.5f, -3));
  EXPECT_EQ(table.rows()[1].size(), 1u);
  EXPECT_EQ(table.rows()[2].words(), std::vector<std::string>{"h#"}) << "the name of a phoneme";
}

TEST(HeadTablesTest, ErrorsNameFileAndLine) {
  const Table table("t.txt", "\nkey 1 x\n");
  EXPECT_EQ(Complaint([&] { table.rows()[0].Number(2); }),
            "t.txt:2: 'x' found where a number was expected");
  EXPECT_EQ(Complaint([&] { table.rows()[0].Number(3); }),
            "t.txt:2: 'key' needs at least 3 values after it, found 2");
  EXPECT_EQ(Complaint([&] { table.Only("other"); }), "t.txt: no line 'other'");
  EXPECT_EQ(Complaint([] { Table("t.txt", "a\na\n").Only("a"); }),
            "t.txt:2: 'a' given a second time");
  EXPECT_NE(Complaint([] { Table("t.txt", "a inf\n").rows()[0].Number(1); }), "no complaint");
}

TEST(HeadTablesTest, ActionUnitTableRefusesNonsense) {
  const auto complain = [](std::string_view text) {
    return Complaint([&] { UnitTable(Table("au.txt", text)); });
  };
  EXPECT_EQ(complain("field 3 1 1 1 1 both 0 0 0\n"),
            "au.txt:1: '3' is no action unit (1, 2, 4-39, 41-999)");
  EXPECT_EQ(complain("field 1 1 1 0 1 both 0 0 0\n"), "au.txt:1: a radius must be positive");
  EXPECT_EQ(complain("field 1 1 1 1 1 left 0 0 0\n"),
            "au.txt:1: 'left' found where above, below or both was expected");
  EXPECT_EQ(complain("\nfeld 1\n"), "au.txt:2: unknown word 'feld'");
  EXPECT_EQ(complain("field 1 1 1 1 1 both 0 101 0\n"),
            "au.txt:1: '101' found where -100 to 100 was expected");
  EXPECT_EQ(complain("field 1 1 1 1 1 both 0 1 0 7\n"), "au.txt:1: '7' is one word too many");
  EXPECT_EQ(complain("close 43 2\n"), "au.txt:1: '2' found where -1 to 1 was expected");
  EXPECT_EQ(complain("damp 4 1 -0.1\n"), "au.txt:1: '-0.1' found where 0 to 1 was expected");
  std::string many;
  for (std::size_t i = 0; i <= UnitTable::kMaxRows; ++i) many += "seal 8 1\n";
  EXPECT_EQ(complain(many), "au.txt:1001: more rows than are read (1000)");
  EXPECT_EQ(complain("crease 9 0 0.3 0 0.4\n"),
            "au.txt:1: 'crease' needs at least 6 values after it, found 5");
  EXPECT_EQ(complain("jaw 26\n"), "au.txt:1: 'jaw' needs at least 2 values after it, found 1");
}

TEST(HeadTablesTest, UnitsThatActTogetherAreCorrected) {
  const UnitTable units(Table("au.txt", "damp 4 1 0.5\noppose 12 18\nstrongest 43 45\n"));
  FaceState state;
  state.au.left[1] = state.au.left[4] = state.au.left[12] = state.au.left[18] = 1;
  state.au.left[43] = 0.4f;
  state.au.left[45] = 0.6f;
  state.au.right[4] = 2;
  const Sided<UnitValues> acting = UnitCombiner(units, {}).ActingUnits(state);
  EXPECT_FLOAT_EQ(acting.left[4], 0.5f);
  EXPECT_FLOAT_EQ(acting.left[12] + acting.left[18], 1);
  EXPECT_FLOAT_EQ(acting.left[43], 0);
  EXPECT_FLOAT_EQ(acting.left[45], 0.6f);
  EXPECT_FLOAT_EQ(acting.right[4], 1.5f) << "above 1 at half rate";
}

TEST(HeadTablesTest, CageAndCurvesAreChecked) {
  EXPECT_EQ(Complaint([&] { ReadCurve(Table("c.txt", "x 0 1 2\ny 0 1\n"), "x", "y"); }),
            "c.txt:2: has 2 values, 'x' has 3");
  EXPECT_EQ(Complaint([&] { ReadCurve(Table("c.txt", "x 0 2 1\ny 0 1 2\n"), "x", "y"); }),
            "c.txt:1: must ascend");
}

EyeAnatomy SomeEye(const std::string& lower_y = "20 17 22") {
  return EyeAnatomy(Table("eye.txt",
                          "ball 30 22 63 12\niris 6 2\nlid_radius -18 0 18\nlid_value 2 13.7 2\n"
                          "lid_shear 0\nupper_lid_x 16 30 44\nupper_lid_y 20 27 22\n"
                          "lower_lid_x 16 30 44\nlower_lid_y " +
                              lower_y + "\nmeet_sag 3\nbelow_fill 0.5 13\n"));
}

TEST(HeadTablesTest, TheLidsEndInTheSameCorners) {
  EXPECT_EQ(Complaint([] { SomeEye("20 17 22.1"); }),
            "eye.txt:9: the lids must end in the same two corners");
}

MouthAnatomy SomeMouth() {
  return MouthAnatomy(
      Table("mouth.txt",
            "corner 25 -42 78\nline_x 0 25\nline_y -43 -42\nline_z 88 78\nupper_x 0 25\n"
            "upper_y 8 0\nlower_x 0 25\nlower_y -9 0\nupper_full 0 .3 0\nlower_full 0 .3 0\n"
            "border_z 3 1\nupper_teeth 7 40 27 2.6 17\nlower_teeth 9.6 40 26 1.3 -15\ncolumn_x 0 4 "
            "8 12 17 21 25\n"
            "bag_ring 0 62 .5 0 0\nbag_ring 12 48 1 0 0\nbag_ring 15 26 1 0 0\n"
            "bag_ring 11 11 1 0 0\nbag_ring 4 5 1 0 1\nbag_ring 0 3 1 0 1\n"
            "bag_web 14 24 3\nbag_height .1 .9\nbag_depth .8 .2\nbag_width 2\n"));
}

std::string CageComplaint(std::string_view curves, std::string_view patches) {
  // An orbit must come first and the lips' rings exist for anything to be built.
  std::string text = "curve orbit";
  for (int i = 0; i < 18; ++i) text += " " + std::to_string(20 + i) + ",22,60";
  text += '\n';
  for (const char* name : {"lip_a", "lip_b", "lip_c"}) {
    text += std::string("curve ") + name;
    for (int i = 0; i < 13; ++i) text += " " + std::to_string(i) + ",-40,80";
    text += '\n';
  }
  text += curves;
  return Complaint([&] {
    ReadCage(Table("curves.txt", text), Table("patches.txt", patches), SomeEye(), SomeMouth());
  });
}

TEST(HeadTablesTest, CageTablesNameFileLineAndFault) {
  EXPECT_EQ(CageComplaint("curve a 1,2\n", ""), "curves.txt:5: a place is x,y,z");
  EXPECT_EQ(CageComplaint("curve a 1,2,x\n", ""),
            "curves.txt:5: 'x' found where a number was expected");
  EXPECT_EQ(CageComplaint("curve a orbit.18\n", ""), "curves.txt:5: there is no point 'orbit.18'");
  EXPECT_EQ(CageComplaint("curve a b.0\n", ""), "curves.txt:5: there is no curve 'b'");
  EXPECT_EQ(CageComplaint("curve a ~ 1,2,3\n", ""),
            "curves.txt:5: ~ must lie between given points");
  EXPECT_EQ(CageComplaint("line a\n", ""), "curves.txt:5: unknown word 'line'");
  EXPECT_EQ(CageComplaint("", "strip wood fine orbit 1 orbit\n"),
            "patches.txt:1: 'wood' found where skin, rim, lip or inside was expected");
  EXPECT_EQ(CageComplaint("", "strip skin fine orbit 1 lip_a\n"),
            "patches.txt:1: lip_a has 13 points, orbit has 18");
  EXPECT_EQ(CageComplaint("", "strip skin fine orbit\n"), "patches.txt:1: CURVE n CURVE expected");
  EXPECT_EQ(CageComplaint("", "blob skin fine orbit\n"), "patches.txt:1: unknown word 'blob'");
}

TEST(HeadTablesTest, IdentitiesAndSlidersAreChecked) {
  EXPECT_EQ(Complaint([] { Changed("galatea", {"colour tail 1 1 1"}); }),
            "i.txt:2: no part of a face is called tail");
  EXPECT_EQ(Complaint([] { SliderWarp(Table("s.txt", "slider a 0 0 0 1 0 1 1 1 1\n"), {}); }),
            "s.txt:1: a radius must be positive");
  EXPECT_EQ(Complaint([] {
              SliderWarp(Table("s.txt", "slider a 0 0 0 1 1 1 1 1 1\n"), {{"b", 1.0f}});
            }),
            "s.txt: no slider 'b'");
}

TEST(HeadTablesTest, FacesHaveTheColoursOfTheBaseHeadButForThoseTheyName) {
  EXPECT_EQ(BasePalette().gum, glm::vec3(0.46f, 0.18f, 0.17f));
  const Palette palette = BuiltInIdentity("galatea").palette;
  EXPECT_EQ(palette.gum, BasePalette().gum);
  EXPECT_NE(palette.hair, BasePalette().hair);
  EXPECT_EQ(Changed("galatea", {"colour gum 0.1 0.2 0.3"}).palette.gum,
            glm::vec3(0.1f, 0.2f, 0.3f));
}

TEST(HeadTablesTest, AFaceRefusesAWordTooManyInARow) {
  for (const char* row :
       {"slider nose_width 0.6 x", "beard 0.6 x", "lashes 0.5 x", "eyes 1 0 0 0 x",
        "fold 0 0 1 1 x", "brows 1 0 0.5 1 x", "creases 0 0 0 0 x",
        "hair long 0 4 -100 -100 1 0 46 x", "hair crop 4 14 260 23 0.25 0.8 0.35 4 0 x",
        "colour gum 0.1 0.2 0.3 x"}) {
    EXPECT_EQ(Complaint([&] { Changed("galatea", {row}); }), "i.txt:2: 'x' is one word too many")
        << row;
  }
}

std::string FeaturesText() {
  std::ifstream file(GALATEA_SOURCE_DIR "/fsm/head/tables/features.txt");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The built-in features with one row replaced.
std::string WithRow(const std::string& name, const std::string& row) {
  std::string text = FeaturesText();
  const std::size_t at = text.find("\n" + name + " ") + 1;
  EXPECT_NE(at, 0u) << name;
  return text.replace(at, text.find('\n', at) - at, row);
}

TEST(HeadTablesTest, EyesAreAsLargeAndTiltedAsTheirRowSays) {
  const auto with = [](const char* row) { return MakeSymmetricHead(Changed("galatea", {row})); };
  const auto slit = [](const Head& head) {
    return head.Landmark("exocanthion_left") - head.Landmark("endocanthion_left");
  };
  const auto usual = with("eyes 1 0 0 0"), other = with("eyes 1.1 5 1 -1");
  EXPECT_NEAR(glm::length(slit(*other)) / glm::length(slit(*usual)), 1.1, 1e-3);
  EXPECT_GT(slit(*other).y - slit(*usual).y, 2);
  const auto height = [](const Head& head) {
    return glm::length(head.Landmark("palpebrale_superius_right") -
                       head.Landmark("palpebrale_inferius_right"));
  };
  EXPECT_NEAR(height(*other), 1.1f * (height(*usual) + 2), 0.2);
  EXPECT_NEAR(other->Landmark("pupil_left").z, usual->Landmark("pupil_left").z, 0.01)
      << "a larger ball lies deeper";
  EXPECT_EQ(Complaint([&] { with("eyes 2 0 0 0"); }),
            "i.txt:2: '2' found where 0.7 to 1.4 was expected");
}

TEST(HeadTablesTest, TheFurrowOverTheUpperLidLiesWhereItsRowSays) {
  const auto strokes = [](const char* row) {
    return MakeHead(Changed("galatea", {row}))->surface().skin_strokes;
  };
  const auto usual = strokes("fold 0 0 1 0"), higher = strokes("fold 1 1 0.5 0");
  ASSERT_EQ(usual.size(), higher.size());
  int moved = 0;
  for (std::size_t i = 0; i < usual.size(); ++i) {
    if (usual[i].root == higher[i].root) continue;
    ++moved;
    EXPECT_GT(higher[i].root.y, usual[i].root.y);
    EXPECT_LT(higher[i].tint.r, 1);
    EXPECT_GT(higher[i].tint.r, usual[i].tint.r) << "half as dark";
  }
  EXPECT_GT(moved, 100);
  EXPECT_EQ(Complaint([&] { strokes("fold 0 9 1 0"); }),
            "i.txt:2: '9' found where -4 to 4 was expected");
}

TEST(HeadTablesTest, HairBeginsWithSingleHairsOnTheSkin) {
  for (const char* face : {"galatea", "memnon"}) {
    const auto strokes = [face](const char* name, const char* row) {
      Identity identity = BuiltInIdentity(face);
      identity.features = std::make_shared<const Features>("mine.txt", WithRow(name, row));
      return MakeHead(std::move(identity))->surface().skin_strokes.size();
    };
    const bool crop = std::string_view(face) == "memnon";
    const auto few = crop ? strokes("crop_hair hairline count", "crop_hair hairline count 10")
                          : strokes("long_hair hairline count", "long_hair hairline count 10");
    const auto many = crop ? strokes("crop_hair hairline count", "crop_hair hairline count 800")
                           : strokes("long_hair hairline count", "long_hair hairline count 800");
    EXPECT_GT(many, few + 400) << face;
  }
}

TEST(HeadTablesTest, CurlsAreDullAndShort) {
  const auto made = [](const char* row) { return MakeHead(Changed("memnon", {row})); };
  const auto sleekest = [](const Head& head) {
    float most = 0;
    for (const auto& part : head.surface().parts) {
      if (part.material != Material::kHair) continue;
      for (std::uint32_t k = part.first_index; k < part.first_index + part.index_count; ++k) {
        const Strand& strand = head.surface().strands[head.surface().indices[k]];
        most = std::max(most, glm::length(strand.along));
      }
    }
    return most;
  };
  const auto straight = made("hair crop 2 5 0 5 1 2 0 3"),
             curled = made("hair crop 2 5 0 5 1 2 0 3 1");
  EXPECT_NEAR(sleekest(*straight), 1, 1e-3);
  EXPECT_LT(sleekest(*curled), 0.2);
  const SkinStroke& long_one = straight->surface().skin_strokes.back();
  const SkinStroke& short_one = curled->surface().skin_strokes.back();
  EXPECT_LT(glm::length(short_one.tip - short_one.root),
            0.5 * glm::length(long_one.tip - long_one.root));
  EXPECT_EQ(Complaint([&] { made("hair crop 2 5 0 5 1 2 0 3 2"); }),
            "i.txt:2: '2' found where 0 to 1 was expected");
}

TEST(HeadTablesTest, BrowsBendAndThinAsTheirRowSays) {
  const auto brows = [](const char* row) {
    auto hairs = MakeHead(Changed("pygmalion", {"beard 0", row}))->surface().skin_strokes;
    // Above the eyes, below the hair, as the height of the unrolled skin has it.
    std::erase_if(hairs, [](const SkinStroke& h) { return h.root.y < 0.69f || h.root.y > 0.75f; });
    return hairs;
  };
  const auto middle_over_ends = [](const std::vector<SkinStroke>& hairs) {
    float low_x = 1, high_x = 0, middle = 0, ends = 0;
    for (const SkinStroke& h : hairs) {
      if (h.root.x < 0.5f) continue;
      low_x = std::min(low_x, h.root.x);
      high_x = std::max(high_x, h.root.x);
    }
    int in_middle = 0, at_ends = 0;
    for (const SkinStroke& h : hairs) {
      const float at = (h.root.x - low_x) / (high_x - low_x);
      if (at > 0.4f && at < 0.7f) {
        middle += h.root.y;
        ++in_middle;
      } else if ((at >= 0 && at < 0.15f) || at > 0.85f) {
        ends += h.root.y;
        ++at_ends;
      }
    }
    return middle / static_cast<float>(in_middle) - ends / static_cast<float>(at_ends);
  };
  const auto arched = brows("brows 1 0 1.4"), straight = brows("brows 1 0 0"),
             thin = brows("brows 1 0 0 0.4");
  EXPECT_GT(middle_over_ends(arched), middle_over_ends(straight) + 0.004f);
  EXPECT_LT(thin.size(), 0.6f * static_cast<float>(straight.size()));
  EXPECT_EQ(Complaint([&] { brows("brows 1 0 3"); }),
            "i.txt:3: '3' found where -0.5 to 2 was expected");
  EXPECT_EQ(Complaint([&] { brows("brows 1 0 1 2"); }),
            "i.txt:3: '2' found where 0 to 1.5 was expected");
}

TEST(HeadTablesTest, AShavedBeardsHairsLieBelowTheNoseAndNotOnTheLips) {
  const auto hairs = [](const char* row) { return MakeHead(Changed("pygmalion", {row})); };
  const auto shaved = hairs("beard 0"), stubbled = hairs("beard 0.6");
  const float nose = SkinUv(shaved->Landmark("subnasale")).y;
  const auto below = [nose](const Head& head) {
    return std::ranges::count_if(head.surface().skin_strokes,
                                 [nose](const SkinStroke& h) { return h.root.y < nose; });
  };
  EXPECT_EQ(below(*shaved), 0);
  EXPECT_GT(below(*stubbled), 1000);
  const float lips = SkinUv({0, -44.5f, 80}).y;
  for (const SkinStroke& h : stubbled->surface().skin_strokes) {
    EXPECT_FALSE(std::abs(h.root.y - lips) < 0.01f && std::abs(h.root.x - 0.5f) < 0.03f)
        << h.root.x << " " << h.root.y;
    EXPECT_TRUE(h.root.y >= nose || glm::length(h.tip - h.root) < 0.02f) << "a long hair";
  }
}

float LowestHair(const Identity& identity) {
  const auto head = MakeSymmetricHead(identity);
  float low = 100;
  for (const auto& part : head->surface().parts) {
    if (part.material != Material::kHair) continue;
    for (std::uint32_t k = part.first_index; k < part.first_index + part.index_count; ++k)
      low = std::min(low, head->rig().data().rest[head->surface().indices[k]].y);
  }
  return low;
}

TEST(HeadTablesTest, LongHairIsAsLongAsItsRowSays) {
  const auto lowest = [](const char* row) { return LowestHair(Changed("galatea", {row})); };
  // Single locks come a little lower than the rest.
  const float usual = lowest("hair long 0 0 -84 -112 0"),
              longer = lowest("hair long 0 0 -84 -150 0");
  EXPECT_NEAR(usual, -120, 8);
  EXPECT_NEAR(usual - longer, 150 - 112, 5);
  EXPECT_TRUE(
      std::holds_alternative<LongStyle>(Changed("pygmalion", {"hair long 0 0 -84 -112 0"}).hair))
      << "who had short hair has it long";
  EXPECT_EQ(Complaint([] { Changed("pygmalion", {"hair long 0.7 0 -84 -112 0"}); }),
            "i.txt:2: '0.7' found where -0.6 to 0.6 was expected");
}

TEST(HeadTablesTest, TuckedHairLeavesTheLeftEarFree) {
  // Hair beside the ear and before it, by side.
  const auto beside = [](const char* row) {
    const auto head = MakeSymmetricHead(Changed("zhenzhen", {row}));
    int left = 0, right = 0;
    for (const auto& part : head->surface().parts) {
      if (part.material != Material::kHair) continue;
      for (const std::uint32_t v : head->surface().Corners(part)) {
        const glm::vec3 p = head->rig().data().rest[v];
        if (p.y < -25 || p.y > 10 || p.z < -15 || p.z > 35) continue;
        ++(p.x > 0 ? left : right);
      }
    }
    return std::pair(left, right);
  };
  const auto hanging = beside("hair long 0.1 4 -124 -142 0"),
             tucked = beside("hair long 0.1 4 -124 -142 0 1");
  EXPECT_GT(hanging.first, 20);
  EXPECT_EQ(tucked.first, 0);
  EXPECT_EQ(tucked.second, hanging.second);
}

TEST(HeadTablesTest, AFringeFallsOverTheForeheadDownToWhereItsRowSays) {
  // Lowest hair before the forehead, and how many of its corners lie within the skin there.
  struct Front {
    float lowest = 200;
    int within = 0;
  };
  const auto before_forehead = [](const char* row) {
    const auto head = MakeSymmetricHead(Changed("zhenzhen", {row}));
    const auto in_front = [&](Material material) {
      std::vector<glm::vec3> points;
      for (const auto& part : head->surface().parts) {
        if (part.material != material) continue;
        for (const std::uint32_t v : head->surface().Corners(part)) {
          const glm::vec3 p = head->rig().data().rest[v];
          if (std::abs(p.x) < 25 && p.z > 60) points.push_back(p);
        }
      }
      return points;
    };
    const auto skin = in_front(Material::kSkin);
    Front front;
    for (const glm::vec3 p : in_front(Material::kHair)) {
      front.lowest = std::min(front.lowest, p.y);
      front.within += std::ranges::any_of(
          skin, [&](glm::vec3 s) { return glm::length(glm::vec2(s - p)) < 4 && s.z > p.z; });
    }
    return front;
  };
  const Front none = before_forehead("hair long 0.1 4 -124 -142 0"),
              high = before_forehead("hair long 0.1 4 -124 -142 0 0 70"),
              low = before_forehead("hair long 0.1 4 -124 -142 0 0 50");
  EXPECT_GT(none.lowest, 70);
  EXPECT_NEAR(high.lowest, 67, 4);
  EXPECT_NEAR(high.lowest - low.lowest, 20, 4);
  EXPECT_EQ(low.within, 0);
}

TEST(HeadTablesTest, CombedHairEndsWhereItsRowSays) {
  const auto lowest = [](const char* row) { return LowestHair(Changed("zhenzhen", {row})); };
  EXPECT_NEAR(lowest("hair tied 4 7 58 -125 0"), -140, 12);
  EXPECT_NEAR(lowest("hair tied 4 7 58 -70 0"), -82, 12);
  EXPECT_GT(lowest("hair swept 10 19 3 0"), -60) << "the nape";
  const auto before_ear = [](const char* row) {
    const auto head = MakeSymmetricHead(Changed("pygmalion", {row}));
    int count = 0;
    for (const auto& part : head->surface().parts) {
      if (part.material != Material::kHair) continue;
      for (const std::uint32_t v : head->surface().Corners(part)) {
        const glm::vec3 p = head->rig().data().rest[v];
        count += p.y < 30 && p.y > 10 && p.z > 2 ? 1 : 0;
      }
    }
    return count;
  };
  EXPECT_GT(before_ear("hair swept 4 15 2 0"), 4) << "whiskers";
  const auto complaint = [](const char* row) {
    return Complaint([row] { Changed("zhenzhen", {row}); });
  };
  EXPECT_EQ(complaint("hair tied 4 7 5 -125 0"), "i.txt:2: '5' found where 10 to 110 was expected");
  EXPECT_EQ(complaint("hair tied 4 7 58 -125 9"), "i.txt:2: 0 to 8 loose strands");
  EXPECT_EQ(complaint("hair swept 10 19 3 2"), "i.txt:2: '2' found where -1 to 1 was expected");
  EXPECT_EQ(complaint("hair shorn"), "i.txt:2: long, crop, tied or swept expected");
}

TEST(HeadTablesTest, FeaturesAreChecked) {
  const std::string built_in = FeaturesText();
  const struct {
    const char *name, *row, *why;
  } cases[] = {
      {"gum_light", "gum_light 0.6", "'gum_light' needs 2 numbers after it, found 1"},
      {"gum_light", "gum_light 0.6 2000", "'2000' found where -1000 to 1000 was expected"},
      {"gum_light", "gum_light 0.6 plus 0.2", "'plus' found where 'to' was expected"},
      {"gum_light", "gum_light 0.6 and 0.2", "'and' found where a number was expected"},
      {"ear_middle", "ear_middle 13 to 0", "'to' found where a number was expected"},
      {"stubble_place height", "stubble_place height -8 up_to -104",
       "the first number of 'stubble_place height' exceeds the second"},
      {"gum_light", "gum_lights 0.6 0.2", "'gum_lights' is not known"},
      {"gum_light", "gum_scallop 1", "'gum_scallop' is there twice"},
      {"brow_growth", "brow_growth 9 86 9 62 22 36 36 16 48 -12 56 -32", "do not ascend"},
      {"lid_fold_height", "lid_fold_height 0 2 0.5 4 0.5 6 0.8 6 1 4", "do not ascend"},
      {"iris_rings", "iris_rings 0.3 1 0.6 0.85", "'iris_rings' needs 6 numbers after it, found 4"},
      {"upper_lashes count", "upper_lashes count 0", "'0' found where 1 to 200 was expected"},
      {"brow_hairs rows", "brow_hairs rows 1e2 7", "'brow_hairs rows' needs 1 numbers"},
      {"brow_hairs rows", "brow_hairs rows 999", "'999' found where 1 to 200 was expected"},
      {"brow_hairs rows", "brow_hairs 72 7",
       "'brow_hairs' is not known; known are brow_hairs columns, brow_hairs rows"},
      {"upper_tooth_widths", "upper_tooth_widths 8 7 0 7 7 7", "'0' found where 0.5 to 100"},
      {"ear_bowl half_size", "ear_bowl half_size 4 0", "'0' found where 0.01 to 100 was expected"},
      {"ear_fork half_width", "ear_fork half_width 0", "'0' found where 0.01 to 100 was expected"},
      {"spot cheeks half_size", "spot cheeks half_size 0 10",
       "'0' found where 0.01 to 100 was expected"},
      {"beard_thin_cheek half_size", "beard_thin_cheek half_size 9 0",
       "'0' found where 0.01 to 100"},
      {"long_hair hanging goes_on", "long_hair hanging goes_on 0",
       "'0' found where 0.01 to 100 was expected"},
      {"long_hair volume half_axes", "long_hair volume half_axes 80 0 90",
       "'0' found where 10 to 1000 was expected"},
      {"crop_hair crown", "crop_hair crown 0 0 0", "a crown that is nowhere"},
      {"long_hair over_ear half_width", "long_hair over_ear half_width 0",
       "'0' found where 0.01 to 100"},
      {"stubble_place lips_half_size", "stubble_place lips_half_size 0 9",
       "'0' found where 0.01 to 100"},
      {"long_hair parting direction_until", "long_hair parting direction_until 0",
       "'0' found where 0.01 to 100 was expected"},
  };
  for (const auto& [name, row, why] : cases) {
    const auto said = Complaint([&] { Features("mine.txt", WithRow(name, row)); });
    EXPECT_TRUE(said.starts_with("mine.txt:")) << said << " for " << row;
    EXPECT_NE(said.find(why), std::string::npos) << said << " for " << row;
  }
  EXPECT_EQ(Complaint([&] { Features("mine.txt", built_in); }), "no complaint");
}

TEST(HeadTablesTest, FeaturesLeftOutAreTheBuiltInOnes) {
  // A row may leave out the word between its numbers.
  const Features mine("mine.txt",
                      "gum_light 0.6 0.25\near_light 0.2 plus 0.8\nspot cheeks half_size 20 10\n");
  EXPECT_EQ(mine.gum_light, (Range{0.6f, 0.25f}));
  EXPECT_EQ(mine.ear_light, (Linear{0.2f, 0.8f}));
  EXPECT_EQ(mine.table().rows().size(), Features::BuiltIn()->table().rows().size());
  for (std::size_t i = 0; i < mine.table().rows().size(); ++i) {
    const std::string name = NumberTable::RowName(Features::BuiltIn()->table().rows()[i]);
    EXPECT_EQ(NumberTable::RowName(mine.table().rows()[i]), name);
    if (name == "gum_light" || name == "ear_light" || name == "spot cheeks half_size") continue;
    EXPECT_EQ(mine.table()[name], Features::BuiltIn()->table()[name]);
  }
}

TEST(HeadTablesTest, FeaturesOfOnesOwnChangeTheHeads) {
  const auto places = [](const char* face, std::shared_ptr<const Features> features) {
    Identity identity = std::string_view(face) == "pygmalion"
                            ? Changed(face, {"hair crop 3 15 60 26 2.5 1.5 0.6 2"})
                            : BuiltInIdentity(face);
    identity.features = std::move(features);
    return MakeHead(std::move(identity))->rig().data().rest;
  };
  const auto with = [](const char* name, const char* row) {
    return std::make_shared<const Features>("mine.txt", WithRow(name, row));
  };
  const auto as_ever = places("pygmalion", Features::BuiltIn());
  EXPECT_EQ(places("pygmalion", std::make_shared<const Features>("mine.txt", FeaturesText())),
            as_ever);
  for (const auto& [name, row] : {std::pair{"lower_tooth_widths", "lower_tooth_widths 5 5 6 7 7 9"},
                                  {"tongue_length", "tongue_length 40"},
                                  {"ear_place height", "ear_place height 1.05"},
                                  {"upper_lash_length", "upper_lash_length 2 3"},
                                  {"ear_edge", "ear_edge 2"},
                                  {"crop_hair lock waves", "crop_hair lock waves 1"},
                                  {"crop_hair crown", "crop_hair crown 0 1 0"}}) {
    EXPECT_NE(places("pygmalion", with(name, row)), as_ever) << row;
  }
  EXPECT_NE(places("galatea", with("long_hair hanging cheek", "long_hair hanging cheek 3")),
            places("galatea", Features::BuiltIn()));
}

TEST(HeadTablesTest, SplineGoesThroughItsPoints) {
  const Curve curve({0, 1, 3, 4}, {2, -1, 5, 0});
  EXPECT_NEAR(curve(0), 2, 1e-4);
  EXPECT_NEAR(curve(1), -1, 1e-4);
  EXPECT_NEAR(curve(3), 5, 1e-4);
  EXPECT_NEAR(curve(9), 0, 1e-4);
  const Curve line({0, 1, 2}, {0, 2, 4});
  EXPECT_NEAR(line(1.3f), 2.6f, 1e-4);
}

}  // namespace
}  // namespace fsm
