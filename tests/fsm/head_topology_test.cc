#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "fsm/head/make_head.h"
#include "tests/fsm/head_fixture.h"

namespace fsm {
namespace {

using testing::GenericHead;
using testing::Vertices;

bool Finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

TEST(HeadSurfaceTest, ArraysAgreeAndIndicesAreInRange) {
  const HeadSurface& topology = GenericHead().surface();
  const HeadVertices rest = Vertices({});
  EXPECT_EQ(topology.albedo.size(), rest.position.size());
  EXPECT_EQ(topology.openness.size(), rest.position.size());
  EXPECT_EQ(rest.normal.size(), rest.position.size());
  for (const std::uint32_t i : topology.indices) ASSERT_LT(i, rest.position.size());
  std::uint32_t next = 0;
  for (const HeadSurface::Part& part : topology.parts) {
    EXPECT_EQ(part.first_index, next);
    EXPECT_EQ(part.index_count % 3, 0u);
    next += part.index_count;
  }
  EXPECT_EQ(next, topology.indices.size());
}

TEST(HeadSurfaceTest, EveryPartOfAFaceIsThereWithinTheBudget) {
  const HeadSurface& topology = GenericHead().surface();
  std::set<Material> found;
  for (const HeadSurface::Part& part : topology.parts) found.insert(part.material);
  EXPECT_EQ(found.size(), 12u);
  EXPECT_GT(topology.indices.size() / 3, 8000u);
  EXPECT_LT(topology.indices.size() / 3, 19600u);
}

TEST(HeadSurfaceTest, BrowsAreHairsAboveBothEyes) {
  const HeadSurface& topology = GenericHead().surface();
  std::array<int, 2> hairs{};
  for (const SkinStroke& hair : topology.skin_strokes) {
    for (const glm::vec2 p : {hair.root, hair.middle, hair.tip}) {
      ASSERT_TRUE(p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1) << p.x << ' ' << p.y;
      ASSERT_GT(p.y, (22.3f + 200) / 340) << "below the pupils";
    }
    ASSERT_GT(hair.width_mm, 0);
    ++hairs[hair.root.x < 0.5f ? 0 : 1];
  }
  EXPECT_GT(hairs[0], 100);
  EXPECT_GT(hairs[1], 100);
}

TEST(HeadSurfaceTest, HairThinsOutOnlyWhereLocksEnd) {
  const HeadSurface& topology = GenericHead().surface();
  ASSERT_EQ(topology.strands.size(), topology.albedo.size());
  std::size_t dense = 0, gone = 0, all = 0;
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material != Material::kHair) continue;
    for (std::uint32_t k = 0; k < part.index_count; ++k) {
      const Strand& strand = topology.strands[topology.indices[part.first_index + k]];
      ASSERT_NEAR(glm::length(strand.along), 1, 1e-3);
      ASSERT_TRUE(strand.density >= 0 && strand.density <= 1) << strand.density;
      ++all;
      dense += strand.density > 0.95f ? 1 : 0;
      gone += strand.density < 0.2f ? 1 : 0;
    }
  }
  EXPECT_GT(dense, all / 2);
  EXPECT_GT(gone, all / 50);
}

TEST(HeadSurfaceTest, PaintAndOpennessAreInRange) {
  const HeadSurface& topology = GenericHead().surface();
  for (const glm::vec3 c : topology.albedo) {
    ASSERT_TRUE(Finite(c));
    ASSERT_GE(std::min({c.x, c.y, c.z}), 0.0f);
    ASSERT_LE(std::max({c.x, c.y, c.z}), 1.0f);
  }
  for (const float o : topology.openness) ASSERT_TRUE(o >= 0 && o <= 1);
}

TEST(HeadSurfaceTest, NormalsAreUnitAndTheFaceLooksAtTheViewer) {
  const HeadVertices rest = Vertices({});
  for (std::size_t i = 0; i < rest.normal.size(); ++i) {
    ASSERT_TRUE(Finite(rest.position[i])) << i;
    ASSERT_NEAR(glm::length(rest.normal[i]), 1, 1e-3) << i;
  }
  for (const auto& [x, y] :
       {std::pair{0.0f, 60.0f}, {30.0f, -10.0f}, {-30.0f, -10.0f}, {0.0f, -72.0f}}) {
    EXPECT_GT(rest.normal[testing::SkinAt(x, y)].z, 0.5f) << x << " " << y;
  }
}

TEST(HeadSurfaceTest, TrianglesFaceOutward) {
  // From the middle of the head, the face's skin must be seen from behind. Folds (ears, nostrils,
  // lid rims, inside of the lips) may look elsewhere.
  const HeadSurface& topology = GenericHead().surface();
  const HeadVertices rest = Vertices({});
  int outward = 0;
  int all = 0;
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material != Material::kSkin && part.material != Material::kSclera &&
        part.material != Material::kIris) {
      continue;
    }
    for (std::uint32_t k = 0; k < part.index_count; k += 3) {
      const std::uint32_t* i = &topology.indices[part.first_index + k];
      const glm::vec3 a = rest.position[i[0]], b = rest.position[i[1]], c = rest.position[i[2]];
      const glm::vec3 middle = (a + b + c) / 3.0f;
      if (middle.z < 45) continue;
      ++all;
      if (glm::dot(glm::cross(b - a, c - a), middle - glm::vec3(0, -10, 20)) > 0) ++outward;
    }
  }
  EXPECT_GT(all, 2000);
  EXPECT_GT(static_cast<double>(outward) / all, 0.87);
}

TEST(HeadSurfaceTest, NoSkinEdgeIsUsedThreeTimes) {
  const HeadSurface& topology = GenericHead().surface();
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t k = 0; k < topology.indices.size(); k += 3) {
    for (std::size_t e = 0; e < 3; ++e) {
      ++edges[{topology.indices[k + e], topology.indices[k + (e + 1) % 3]}];
    }
  }
  for (const auto& [edge, count] : edges) ASSERT_EQ(count, 1) << edge.first << " " << edge.second;
}

TEST(HeadSurfaceTest, FaceIsMirrorSymmetric) {
  // Hair is parted on one side; everything else has its mirror image.
  const HeadSurface& topology = GenericHead().surface();
  const HeadVertices rest = Vertices({});
  std::set<std::uint32_t> face;
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material == Material::kHair) continue;
    face.insert(&topology.indices[part.first_index],
                &topology.indices[part.first_index] + part.index_count);
  }
  std::map<std::array<int, 3>, int> seen;
  const auto key = [](glm::vec3 p) {
    const auto r = [](float v) { return static_cast<int>(std::lround(v * 10)); };
    return std::array{std::abs(r(p.x)), r(p.y), r(p.z)};
  };
  std::map<std::array<int, 3>, int> balance;
  for (const std::uint32_t i : face) {
    const glm::vec3 p = rest.position[i];
    if (std::abs(p.x) > 0.06f) balance[key(p)] += p.x > 0 ? 1 : -1;
  }
  int lonely = 0;
  for (const auto& [place, sum] : balance) lonely += std::abs(sum);
  EXPECT_LT(lonely, static_cast<int>(face.size()) / 50);  // rounding may part a few pairs
}

TEST(HeadSurfaceTest, ProportionsAreThoseOfAWoman) {
  // Farkas' norms for women, millimetres: mouth 50.2, eye slit 30.7, between the inner
  // corners 31.8.
  const HeadVertices rest = Vertices({});
  const MouthMeasure mouth = GenericHead().MeasureMouth({});
  EXPECT_NEAR(mouth.width_mm, 50.2, 2);
  float tip = 0, crown = -1000;
  for (const glm::vec3 p : rest.position) {
    if (std::abs(p.x) < 2) tip = std::max(tip, p.z);
    crown = std::max(crown, p.y);
  }
  EXPECT_NEAR(tip, 106, 4);     // nose tip before the ears: 103.8
  EXPECT_NEAR(crown, 140, 12);  // hair included
}

TEST(HeadSurfaceTest, TwoHeadsAreTheSame) {
  const auto other = MakeHead("galatea");
  HeadVertices a;
  other->Evaluate({}, a);
  const HeadVertices b = Vertices({});
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(other->surface().indices, GenericHead().surface().indices);
}

}  // namespace
}  // namespace fsm
