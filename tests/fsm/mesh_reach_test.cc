// What happens to heads whose numbers are far too large.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "fsm/mesh/align_imported_head.h"
#include "fsm/mesh/gltf/gltf_head.h"
#include "fsm/mesh/head_points.h"
#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/transfer/deformation_transfer.h"
#include "fsm/mesh/transfer/surface_index.h"
#include "fsm/rig/reach.h"
#include "tests/fsm/gltf_maker.h"

namespace fsm {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

TEST(MeshReachTest, EndsAtTenKilometresAndHasNoPlaceForWhatIsNoNumber) {
  EXPECT_TRUE(WithinReach({1e7F, -1e7F, 0}));
  for (const float bad : {1.001e7F, -1e8F, kInfinite, -kInfinite, kNone}) {
    EXPECT_FALSE(WithinReach({bad, 0, 0})) << bad;
    EXPECT_FALSE(WithinReach({0, bad, 0})) << bad;
    EXPECT_FALSE(WithinReach({0, 0, bad})) << bad;
  }
}

/// A triangle under a node, with one morph target.
std::string Triangle(const char* node, const std::vector<float>& places,
                     const std::vector<float>& by) {
  GltfMaker maker;
  const int at = maker.Places(places), moved = maker.Places(by);
  return maker.File(R"("nodes":[{"mesh":0)" + std::string(node) +
                    R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":)" +
                    std::to_string(at) + R"(},"targets":[{"POSITION":)" + std::to_string(moved) +
                    "}]}]}]");
}

const std::vector<float> kSmall{0, 0, 0, 1, 0, 0, 0, 1, 0};

void ExpectRefused(const std::string& json, const std::string& words) {
  const auto file = ParseGltfHead("a.gltf", json);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, vm::Errc::kBadValue);
  EXPECT_NE(file.error().text.find(words), std::string::npos) << file.error().text;
}

TEST(MeshReachTest, AVertexThatItsNodeTakesOutOfReachIsRefusedWithFileAndPlace) {
  ASSERT_TRUE(ParseGltfHead("a.gltf", Triangle(R"(,"scale":[1000,1000,1000])", kSmall, kSmall)));
  ExpectRefused(Triangle(R"(,"scale":[1000,1000,1000])", {0, 0, 0, 1e38F, 0, 0, 0, 1, 0}, kSmall),
                "a.gltf: meshes[0] of nodes[0]: vertex 1 comes to lie");
  ExpectRefused(Triangle("", {0, 0, 0, 1, 0, 0, 0, 1, -2e7F}, kSmall),
                "a.gltf: meshes[0] of nodes[0]: vertex 2 comes to lie");
}

TEST(MeshReachTest, AMorphTargetThatMovesAVertexOutOfReachIsRefused) {
  ExpectRefused(Triangle(R"(,"scale":[1,1000,1])", kSmall, {0, 0, 0, 0, 0, 0, 0, 1e38F, 0}),
                "vertex 2 is moved by target 0 and comes to lie");
}

TEST(MeshReachTest, LandmarksThatEnlargeAHeadBeyondReachAreRefusedWithItsName) {
  const auto file = ParseGltfHead("a.gltf", Triangle("", kSmall, kSmall));
  ASSERT_TRUE(file) << file.error().text;
  const auto refused = [&](const Similarity& place) -> std::string {
    try {
      (void)AlignImportedHead(*file, place, -43);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({.rotation = glm::mat3(1.0F), .scale = 1e12F, .translation = {}})
                .find("a.gltf: vertex 1"),
            0U);
  // As eight landmarks at one place give it.
  EXPECT_EQ(refused({.rotation = glm::mat3(kNone), .scale = 1, .translation = {}})
                .find("a.gltf: vertex 0"),
            0U);
}

TEST(MeshReachTest, LandmarksOutOfReachAreRefusedWithTheirLine) {
  for (const char* line : {"point plain 1 2 3 4 5 1e30\n", "point plain 1 -2e7 3 4 5 6\n"}) {
    const auto read = ParseHeadPoints("p", std::string("face galatea\n") + line);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().text.find("p:2: six numbers of at most"), 0U) << read.error().text;
  }
}

/// A closed surface and places on it that lie in no plane.
struct Box {
  std::vector<glm::vec3> place;
  std::vector<std::uint32_t> triangles;
  std::vector<PointPair> pairs;

  Box() {
    for (int i = 0; i < 8; ++i) {
      place.emplace_back((i & 1) != 0 ? 50 : -50, (i & 2) != 0 ? 60 : -60, (i & 4) != 0 ? 70 : 0);
      pairs.push_back({place.back(), place.back() + glm::vec3(1, 2, 3), FaceFeature::kNone});
    }
    triangles = {4, 5, 7, 4, 7, 6, 1, 0, 2, 1, 2, 3, 0, 4, 6, 0, 6, 2,
                 5, 1, 3, 5, 3, 7, 6, 7, 3, 6, 3, 2, 0, 1, 5, 0, 5, 4};
  }
};

TEST(MeshReachTest, NothingIsCarriedToOrFromVerticesAndPlacesOutOfReach) {
  const Box good;
  EXPECT_NO_THROW(
      DeformationTransfer({good.place, good.triangles}, {good.place, good.triangles}, good.pairs));
  for (const float bad : {3e38F, kInfinite, kNone}) {
    Box far;
    far.place[5].y = bad;
    EXPECT_THROW(
        DeformationTransfer({good.place, good.triangles}, {far.place, far.triangles}, good.pairs),
        std::runtime_error)
        << bad;
    EXPECT_THROW(
        DeformationTransfer({far.place, far.triangles}, {good.place, good.triangles}, good.pairs),
        std::runtime_error)
        << bad;
    Box lost;
    lost.pairs[3].to.x = bad;
    EXPECT_THROW(
        DeformationTransfer({good.place, good.triangles}, {good.place, good.triangles}, lost.pairs),
        std::runtime_error)
        << bad;
  }
}

/// A patch of skin that faces the viewer, at z.
void AddPatch(float x, float y, float z, float size, std::vector<glm::vec3>& place,
              std::vector<std::uint32_t>& triangles) {
  for (const glm::vec3 p : {glm::vec3(0, 0, 0), {size, 0, 0}, {0, size, 0}}) {
    place.push_back(glm::vec3(x, y, z) + p);
    triangles.push_back(static_cast<std::uint32_t>(place.size() - 1));
  }
}

WeldedSurface Welded(const std::vector<glm::vec3>& place,
                     const std::vector<std::uint32_t>& triangles) {
  WeldedSurface surface(place, triangles, false);
  surface.ComputeVisibility(place, {});
  return surface;
}

TEST(SurfaceIndexTest, ATriangleTenMetresLargeIsLeftOut) {
  std::vector<glm::vec3> place;
  std::vector<std::uint32_t> triangles;
  AddPatch(0, 0, 0, 5, place, triangles);
  // 1429 cells of 7 mm on each side, whose product is no int.
  for (const glm::vec3 p :
       {glm::vec3(-5000), glm::vec3(5000, -5000, 0), glm::vec3(0, 5000, 5000)}) {
    place.push_back(p);
    triangles.push_back(static_cast<std::uint32_t>(place.size() - 1));
  }
  const WeldedSurface surface = Welded(place, triangles);
  const SurfaceIndex index(surface, 14);
  const auto hit = index.Find(surface, 0);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->triangle, 0U);
  EXPECT_EQ(index.Find(surface, 4), std::nullopt) << "a corner of the large one";
}

TEST(WeldedSurfaceTest, TrianglesInTooManyLayersAreRefused) {
  std::vector<glm::vec3> place;
  std::vector<std::uint32_t> triangles;
  for (int i = 0; i < 300; ++i) {
    AddPatch(0, 0, static_cast<float>(i), 997, place, triangles);
  }
  WeldedSurface many(place, triangles, false);
  EXPECT_THROW(many.ComputeVisibility(place, {}), std::runtime_error);
  // Larger ones than a square metre are looked at as quickly as they are many.
  for (glm::vec3& p : place) p *= 1000.0F;
  WeldedSurface large(place, triangles, false);
  EXPECT_NO_THROW(large.ComputeVisibility(place, {}));
}

TEST(SurfaceIndexTest, TrianglesInTooManyCellsAreRefused) {
  std::vector<glm::vec3> place;
  std::vector<std::uint32_t> triangles;
  // Each lies in 64 x 64 cells of a millimetre.
  for (int i = 0; i < 1100; ++i) {
    AddPatch(0.5F, 0.5F, 2 * static_cast<float>(i) + 0.5F, 63, place, triangles);
  }
  const WeldedSurface all = Welded(place, triangles);
  EXPECT_THROW(SurfaceIndex(all, 2), std::runtime_error);
  place.resize(300);
  triangles.resize(300);
  const WeldedSurface some = Welded(place, triangles);
  EXPECT_NO_THROW(SurfaceIndex(some, 2));
}

}  // namespace
}  // namespace fsm
