// What happens to heads whose numbers are far too large.

#include "fsm/mesh/mesh_reach.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "fsm/mesh/carry.h"
#include "fsm/mesh/head_file.h"
#include "fsm/mesh/head_points.h"
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
      (void)ModelOf(*file, place, -43);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({.turn = glm::mat3(1.0F), .scale = 1e12F, .move = {}}).find("a.gltf: vertex 1"),
            0U);
  // As eight landmarks at one place give it.
  EXPECT_EQ(refused({.turn = glm::mat3(kNone), .scale = 1, .move = {}}).find("a.gltf: vertex 0"),
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
  std::vector<PlacePair> pairs;

  Box() {
    for (int i = 0; i < 8; ++i) {
      place.emplace_back((i & 1) != 0 ? 50 : -50, (i & 2) != 0 ? 60 : -60, (i & 4) != 0 ? 70 : 0);
      pairs.push_back({place.back(), place.back() + glm::vec3(1, 2, 3), FacePart::kPlain});
    }
    triangles = {4, 5, 7, 4, 7, 6, 1, 0, 2, 1, 2, 3, 0, 4, 6, 0, 6, 2,
                 5, 1, 3, 5, 3, 7, 6, 7, 3, 6, 3, 2, 0, 1, 5, 0, 5, 4};
  }
};

TEST(MeshReachTest, NothingIsCarriedToOrFromVerticesAndPlacesOutOfReach) {
  const Box good;
  EXPECT_NO_THROW(Carry({good.place, good.triangles}, {good.place, good.triangles}, good.pairs));
  for (const float bad : {3e38F, kInfinite, kNone}) {
    Box far;
    far.place[5].y = bad;
    EXPECT_THROW(Carry({good.place, good.triangles}, {far.place, far.triangles}, good.pairs),
                 std::runtime_error)
        << bad;
    EXPECT_THROW(Carry({far.place, far.triangles}, {good.place, good.triangles}, good.pairs),
                 std::runtime_error)
        << bad;
    Box lost;
    lost.pairs[3].to.x = bad;
    EXPECT_THROW(Carry({good.place, good.triangles}, {good.place, good.triangles}, lost.pairs),
                 std::runtime_error)
        << bad;
  }
}

}  // namespace
}  // namespace fsm
