#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "fsm/head/make_head.h"
#include "tests/fsm/head_fixture.h"

namespace fsm {
namespace {

using testing::GenericHead;
using testing::Vertices;
using testing::WithUnit;

/// Farkas' norms for women, millimetres.
struct Distance {
  const char* from;
  const char* to;
  float mm;
};

class Farkas : public ::testing::TestWithParam<Distance> {};

TEST_P(Farkas, DistanceIsWithinTwoMillimetres) {
  const Distance d = GetParam();
  EXPECT_NEAR(glm::length(GenericHead().Landmark(d.from) - GenericHead().Landmark(d.to)), d.mm, 2);
}

INSTANTIATE_TEST_SUITE_P(
    HeadFormTest, Farkas,
    ::testing::Values(
        Distance{"nasion", "gnathion", 111.4f}, Distance{"subnasale", "gnathion", 64.3f},
        Distance{"trichion", "nasion", 63}, Distance{"zygion_left", "zygion_right", 130},
        Distance{"gonion_left", "gonion_right", 91}, Distance{"eurion_left", "eurion_right", 144},
        Distance{"glabella", "opisthocranion", 187},
        Distance{"endocanthion_left", "endocanthion_right", 31.8f},
        Distance{"exocanthion_left", "exocanthion_right", 87.8f},
        Distance{"exocanthion_left", "endocanthion_left", 30.7f},
        Distance{"palpebrale_superius_left", "palpebrale_inferius_left", 10.9f},
        Distance{"alare_left", "alare_right", 31.4f}, Distance{"nasion", "subnasale", 50.6f},
        Distance{"subnasale", "pronasale", 19.7f},
        Distance{"cheilion_left", "cheilion_right", 50.2f}, Distance{"subnasale", "stomion", 20.1f},
        Distance{"labiale_superius", "stomion", 8.4f},
        Distance{"stomion", "labiale_inferius", 9.7f},
        Distance{"superaurale_left", "subaurale_left", 59},
        Distance{"preaurale_left", "postaurale_left", 33},
        Distance{"tragion_left", "tragion_right", 131.4f}),
    [](const auto& test) { return std::string(test.param.from) + "_" + test.param.to; });

TEST(HeadFormTest, PupilsLieHalfwayDownTheHead) {
  const Head& head = GenericHead();
  const float middle = 0.5f * (head.Landmark("vertex").y + head.Landmark("gnathion").y);
  EXPECT_NEAR(head.Landmark("pupil_left").y, middle, 3);
}

TEST(HeadFormTest, ProfileHasItsDepths) {
  // Behind the tip of the nose, after the measured heads of 4.1 (ICT) and the young woman there.
  const Head& head = GenericHead();
  const float tip = head.Landmark("pronasale").z;
  for (const auto& [name, depth] : {std::pair{"nasion", 21.5f},
                                    {"glabella", 19.5f},
                                    {"subnasale", 15.0f},
                                    {"labiale_superius", 12.5f},
                                    {"stomion", 17.5f},
                                    {"labiale_inferius", 15.5f},
                                    {"pogonion", 24.0f},
                                    {"cheilion_left", 28.0f},
                                    {"endocanthion_left", 38.0f},
                                    {"exocanthion_left", 43.0f}}) {
    EXPECT_NEAR(tip - head.Landmark(name).z, depth, 3) << name;
  }
}

TEST(HeadFormTest, SkinBelowTheInnerCornerOfAnEyeHasNoTrench) {
  // Downward from the lid's margin the skin comes forward to the cheek.
  const Head& head = GenericHead();
  std::map<int, float> front;  // z by y in whole millimetres, negative so that lower is later
  for (const auto& part : head.surface().parts) {
    if (part.material != Material::kSkin) continue;
    for (const std::uint32_t v : head.surface().Corners(part)) {
      const glm::vec3 p = head.rig().data().rest[v];
      if (std::abs(std::abs(p.x) - 20.1f) > 0.8f || p.y < 9 || p.y > 17.2f) continue;
      auto [at, is_new] = front.try_emplace(-static_cast<int>(p.y), p.z);
      at->second = std::max(at->second, p.z);
    }
  }
  ASSERT_GT(front.size(), 4u);
  float foremost = 0;
  for (const auto& [down, z] : front) {
    EXPECT_GT(z, foremost - 1.5f) << "y " << -down;
    foremost = std::max(foremost, z);
  }
}

TEST(HeadFormTest, UnknownNamesAreRefused) {
  EXPECT_THROW(GenericHead().Landmark("third_eye"), std::out_of_range);
  try {
    MakeHead("nobody");
    FAIL();
  } catch (const std::runtime_error& error) {
    for (const std::string& identity : Identities()) {
      EXPECT_NE(std::string(error.what()).find(identity), std::string::npos);
    }
  }
}

std::vector<std::uint32_t> Members(const HeadSurface& topology, bool hair) {
  std::vector<std::uint32_t> found;
  for (const HeadSurface::Part& part : topology.parts) {
    if ((part.material == Material::kHair) != hair) continue;
    found.insert(found.end(), &topology.indices[part.first_index],
                 &topology.indices[part.first_index] + part.index_count);
  }
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  return found;
}

TEST(HeadFormTest, IsMirroredToATenthOfAMicrometreBeforeAsymmetry) {
  // Every skin, lip and lid vertex has an image within 1e-4 on the other side.
  const HeadVertices rest = Vertices({});
  std::map<std::array<long, 3>, std::vector<glm::vec3>> cells;
  const auto key = [](glm::vec3 p) {
    return std::array{std::lround(p.x * 10), std::lround(p.y * 10), std::lround(p.z * 10)};
  };
  const auto members = Members(GenericHead().surface(), false);
  for (const std::uint32_t i : members) cells[key(rest.position[i])].push_back(rest.position[i]);
  int lonely = 0;
  for (const std::uint32_t i : members) {
    const glm::vec3 p = rest.position[i];
    const glm::vec3 image(-p.x, p.y, p.z);
    bool found = false;
    const auto k = key(image);
    for (long dx = -1; dx <= 1 && !found; ++dx) {
      for (long dy = -1; dy <= 1 && !found; ++dy) {
        for (long dz = -1; dz <= 1 && !found; ++dz) {
          const auto cell = cells.find({k[0] + dx, k[1] + dy, k[2] + dz});
          if (cell == cells.end()) continue;
          for (const glm::vec3 q : cell->second) found |= glm::length(q - image) < 1e-4f;
        }
      }
    }
    if (!found) ++lonely;
  }
  EXPECT_EQ(lonely, 0);
}

TEST(HeadFormTest, SkinHasNoOpenEdgeButAtTheNeck) {
  const HeadSurface& topology = GenericHead().surface();
  const HeadVertices rest = Vertices({});
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material != Material::kSkin && part.material != Material::kLip &&
        part.material != Material::kMouthInside) {
      continue;
    }
    for (std::uint32_t k = 0; k < part.index_count; k += 3) {
      const std::uint32_t* i = &topology.indices[part.first_index + k];
      for (std::size_t e = 0; e < 3; ++e) ++edges[std::minmax(i[e], i[(e + 1) % 3])];
    }
  }
  int open = 0;
  for (const auto& [edge, count] : edges) {
    ASSERT_LE(count, 2);
    if (count == 2) continue;
    const glm::vec3 p = rest.position[edge.first];
    // The scalp ends under the hair, the neck under the collar.
    const bool neck = p.y < -120 || (p.y > -40 && p.z < 62 - 0.5f * std::max(0.0f, 100 - p.y));
    EXPECT_TRUE(neck) << p.x << " " << p.y << " " << p.z;
    if (!neck && ++open > 5) break;
  }
}

TEST(HeadFormTest, FitsTheBudget) {
  for (const std::string& identity : Identities()) {
    const auto head = MakeHead(identity);
    EXPECT_LT(head->surface().indices.size() / 3, 20200u) << identity;
    EXPECT_EQ(head->surface().uv.size(), head->surface().albedo.size());
  }
}

TEST(HeadFormTest, IdentitiesDiffer) {
  const auto& names = Identities();
  ASSERT_GE(names.size(), 3u);
  for (std::size_t a = 0; a < names.size(); ++a) {
    for (std::size_t b = a + 1; b < names.size(); ++b) {
      const auto one = MakeHead(names[a]);
      const auto two = MakeHead(names[b]);
      float most = 0;
      for (const char* name : {"gonion_left", "pronasale", "gnathion", "alare_left"}) {
        most = std::max(most, glm::length(one->Landmark(name) - two->Landmark(name)));
      }
      EXPECT_GT(most, 1.5f) << names[a] << " " << names[b];
      EXPECT_NE(one->surface().eyes.right.iris_colour, two->surface().eyes.right.iris_colour);
    }
  }
}

TEST(HeadFormTest, CreasesFollowTheirUnitsAndSides) {
  FaceState state;
  state.au.left[1] = state.au.left[2] = 1;
  const HeadVertices v = Vertices(state);
  for (const Crease forehead : {Crease::kForehead, Crease::kForeheadSides}) {
    EXPECT_GT(Of(v.creases, forehead).left, 0.8f);
    EXPECT_EQ(Of(v.creases, forehead).right, 0);
  }
  EXPECT_GT(Vertices(WithUnit(4, 1)).creases[1].right, 0.5f);
  EXPECT_GT(Vertices(WithUnit(6, 1)).creases[2].right, 0.5f);
  EXPECT_GT(Vertices(WithUnit(12, 1)).creases[3].left, 0.5f);
  EXPECT_GT(Of(Vertices(WithUnit(9, 1)).creases, Crease::kNose).left, 0.8f);
  EXPECT_EQ(Of(Vertices(WithUnit(4, 1)).creases, Crease::kNose).left, 0)
      << "anger has no lines across the nose";
}

TEST(HeadFormTest, Unit1CreasesTheMiddleOfTheForeheadAndUnit2ItsSides) {
  const HeadVertices inner = Vertices(WithUnit(1, 1)), outer = Vertices(WithUnit(2, 1));
  EXPECT_GT(Of(inner.creases, Crease::kForehead).left,
            3 * Of(inner.creases, Crease::kForeheadSides).left);
  EXPECT_GT(Of(outer.creases, Crease::kForeheadSides).left,
            3 * Of(outer.creases, Crease::kForehead).left);
}

TEST(HeadFormTest, AnOwnUnitCreasesTheSkinByItsRow) {
  const UnitTable own(Table("own.txt", "crease 151 0 0 0.5 0 0\n"));
  HeadVertices v;
  GenericHead().WithUnits(own)->Evaluate(WithUnit(151, 1), v);
  const float rest = Vertices({}).creases[2].left;
  EXPECT_FLOAT_EQ(v.creases[2].left, rest + 0.5f);
  EXPECT_EQ(UnitTable(Table("own.txt", own.Text())).Text(), own.Text());
}

TEST(HeadFormTest, ACreaseWithoutItsLastNumberIsThatOfTheWholeForehead) {
  const UnitTable own(Table("own.txt", "crease 151 0.5 0 0 0 0\n"));
  HeadVertices v;
  GenericHead().WithUnits(own)->Evaluate(WithUnit(151, 1), v);
  const HeadVertices rest = Vertices({});
  for (const Crease forehead : {Crease::kForehead, Crease::kForeheadSides}) {
    EXPECT_FLOAT_EQ(Of(v.creases, forehead).left, Of(rest.creases, forehead).left + 0.5f);
  }
}

}  // namespace
}  // namespace fsm
