#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "face_fit/find/head/lid_edges.h"
#include "face_fit/find/head/lip_seam.h"
#include "fsm/head/make_head.h"
#include "fsm/mesh/rigging/transferred_rig.h"

namespace facefit {

/// The built-in head, whose own units say which lip and which lid a place belongs to.
class BuiltInHeadTest : public testing::Test {
 protected:
  BuiltInHeadTest() : head_(fsm::MakeSymmetricHead("galatea")) { head_->Evaluate({}, rest_); }

  std::optional<LidEdges> Lids(const fsm::HeadVertices& at, fsm::Side side) const {
    return FindLidEdges(*head_, at.position, EyeVertices(head_->surface()), side);
  }
  std::optional<LipSeam> Seam(const fsm::HeadVertices& at) const {
    // Skin above and below the lips, wherever it is now.
    const auto flesh = fsm::SkinTriangles(head_->surface());
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
    return FindLipSeam(head_->surface(), at.position, fsm::SkinTriangles(head_->surface()), false,
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

}  // namespace facefit
