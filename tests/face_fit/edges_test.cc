#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "face_fit/find/head/lid_edges.h"
#include "face_fit/find/head/lip_seam.h"
#include "fsm/head/make_head.h"
#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/transferred_rig.h"

namespace facefit {
namespace {

/// The built-in head, whose own units say which lip and which lid a place belongs to.
class EdgesTest : public testing::Test {
 protected:
  EdgesTest() : head_(fsm::MakeHead("galatea", false)) { head_->Evaluate({}, rest_); }

  std::optional<LidEdges> Lids(const fsm::HeadVertices& at, fsm::Side side) const {
    const auto& topology = head_->topology();
    return FindLidEdges(topology, at.position, EyeVertices(topology), topology.eyes[side].centre,
                        fsm::SignOf(side));
  }
  std::optional<LipSeam> Seam(const fsm::HeadVertices& at) const {
    // Skin above and below the lips, wherever it is now.
    const auto flesh = fsm::SkinTriangles(head_->topology());
    const auto now = [&](glm::vec3 p) {
      const auto nearest = std::ranges::min_element(
          flesh, {}, [&](std::uint32_t v) { return glm::distance(rest_.position[v], p); });
      return at.position[*nearest];
    };
    std::vector<glm::vec3> upper, lower;
    const glm::vec3 mouth = head_->Landmark("stomion");
    for (const float x : {-14.0F, 0.0F, 14.0F}) {
      upper.push_back(now(mouth + glm::vec3(x, 7, 0)));
      lower.push_back(now(mouth + glm::vec3(x, -8, 0)));
    }
    return FindLipSeam(head_->topology(), at.position, fsm::SkinTriangles(head_->topology()), false,
                       upper, lower);
  }
  fsm::HeadVertices Shown(const fsm::FaceState& state) const {
    fsm::HeadVertices vertices;
    head_->Evaluate(state, vertices);
    return vertices;
  }
  float Fall(const MeshPoint& place, const fsm::HeadVertices& moved) const {
    return place.On(rest_.position).y - place.On(moved.position).y;
  }

  std::unique_ptr<fsm::Head> head_;
  fsm::HeadVertices rest_;
};

TEST_F(EdgesTest, LidEdgesLieBesideTheEyeballInOrder) {
  for (const fsm::Side side : fsm::kSides) {
    const auto edges = Lids(rest_, side);
    ASSERT_TRUE(edges) << fsm::SignOf(side);
    const auto& eye = head_->topology().eyes[side];
    const glm::vec3 outer = edges->outer.On(rest_.position),
                    inner = edges->inner.On(rest_.position);
    EXPECT_GT(std::abs(outer.x), std::abs(inner.x) + 20);
    float before = std::abs(outer.x);
    for (std::size_t k = 0; k < LidEdges::kBetween; ++k) {
      const glm::vec3 above = edges->upper[k].On(rest_.position),
                      below = edges->lower[k].On(rest_.position);
      EXPECT_GT(above.y, below.y) << k;
      EXPECT_LT(std::abs(above.x), before) << k;
      before = std::abs(above.x);
      for (const glm::vec3 p : {above, below}) {
        EXPECT_LT(std::abs(glm::distance(p, eye.centre) - eye.ball_radius), 3) << k;
      }
    }
  }
}

TEST_F(EdgesTest, UpperEdgeFallsWhenTheEyeCloses) {
  const auto edges = Lids(rest_, fsm::Side::kRight);
  ASSERT_TRUE(edges);
  fsm::FaceState shut;
  shut.blink.right = 1;
  const auto moved = Shown(shut);
  const std::size_t middle = LidEdges::kBetween / 2;
  const float opening =
      edges->upper[middle].On(rest_.position).y - edges->lower[middle].On(rest_.position).y;
  EXPECT_GT(Fall(edges->upper[middle], moved), 0.7F * opening);
  EXPECT_LT(Fall(edges->lower[middle], moved), 0.1F);
}

TEST_F(EdgesTest, ShutEyesHaveNoEdges) {
  fsm::FaceState shut;
  shut.blink.right = shut.blink.left = 1;
  EXPECT_FALSE(Lids(Shown(shut), fsm::Side::kRight));
}

TEST_F(EdgesTest, SeamTellsTheLipsApart) {
  const auto seam = Seam(rest_);
  ASSERT_TRUE(seam);
  fsm::FaceState open;
  open.asymmetry = 0;
  open.au.left[27] = open.au.right[27] = 1;
  const auto moved = Shown(open);
  for (float along = 0.1F; along < 0.95F; along += 0.1F) {
    const auto& [upper, lower] = seam->At(along);
    EXPECT_LT(
        glm::distance(glm::vec2(upper.On(rest_.position)), glm::vec2(lower.On(rest_.position))), 1)
        << "they meet";
    EXPECT_GT(Fall(lower, moved), Fall(upper, moved) + 2) << along;
  }
  const auto& [upper, lower] = seam->At(0.5F);
  EXPECT_GT(Fall(lower, moved), Fall(upper, moved) + 20);
  const glm::vec3 right = seam->At(0).upper.On(rest_.position),
                  left = seam->At(1).upper.On(rest_.position);
  const float width = head_->MeasureMouth({}).width_mm;
  EXPECT_NEAR(left.x - right.x, width, 0.2F * width);
}

TEST_F(EdgesTest, PartedLipsHaveTwoEdges) {
  fsm::FaceState open;
  open.asymmetry = 0;
  open.au.left[26] = open.au.right[26] = 1;
  const auto moved = Shown(open);
  const auto seam = Seam(moved);
  ASSERT_TRUE(seam);
  const auto& [upper, lower] = seam->At(0.5F);
  const float gap = upper.On(moved.position).y - lower.On(moved.position).y;
  EXPECT_GT(gap, 3);
  EXPECT_NEAR(gap, head_->MeasureMouth(open).gap_mm, 3);
}

TEST_F(EdgesTest, NoLipsNoSeam) {
  EXPECT_FALSE(FindLipSeam(head_->topology(), rest_.position, fsm::SkinTriangles(head_->topology()),
                           false, {}, {}));
  // A forehead has none.
  const std::vector<glm::vec3> above{{-10, 70, 80}, {10, 70, 80}},
      below{{-10, 55, 85}, {10, 55, 85}};
  EXPECT_FALSE(FindLipSeam(head_->topology(), rest_.position, fsm::SkinTriangles(head_->topology()),
                           false, above, below));
}

}  // namespace
}  // namespace facefit
