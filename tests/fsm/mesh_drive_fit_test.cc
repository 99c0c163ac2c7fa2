#include <gtest/gtest.h>

#include <algorithm>

#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/transfer/drive_fit.h"
#include "fsm/mesh/unrigged_head.h"

namespace fsm {
namespace {

/// A head of one vertex for each target, moved by 1 mm to the right for each weight of 1.
std::unique_ptr<Head> HeadOf(std::vector<std::vector<Channel::Driver>> drivers) {
  UnriggedHead model;
  RigData skin = MakeStillSkin();
  skin.steps = {RigStep::kChannels};
  for (auto& by : drivers) {
    Channel& channel = skin.channels.emplace_back();
    channel.drivers = std::move(by);
    channel.moves = {{model.Add(glm::vec3(0), Bone::kSkin, glm::vec3(1)), glm::vec3(1, 0, 0)}};
  }
  while (model.mesh.position.size() < 3) model.Add(glm::vec3(0), Bone::kSkin, glm::vec3(1));
  model.mesh.Triangle(Material::kSkin, 0, 1, 2);
  return RigUnriggedHead(std::move(model), std::move(skin));
}

float WeightOf(const Head& head, std::size_t target, const FaceState& state) {
  HeadVertices vertices;
  head.Evaluate(state, vertices);
  return vertices.position[target].x;
}

TEST(DriveFitTest, ASidedNumberIsMetOnEitherSideAndOnBoth) {
  // By the right side, by the sum, by the stronger one, and by what the right is stronger.
  DriveFit fit(4);
  fit.AddSided({.kind = Drive::Kind::kCommandedUnit, .number = 30}, 1,
               [](const Sided<bool>& raised) {
                 const float r = raised.right ? 1 : 0, l = raised.left ? 1 : 0;
                 return DriveFit::Weights{r, 0.5F * (r + l), std::max(r, l), std::max(r - l, 0.0F)};
               });
  const auto head = HeadOf(fit.ReleaseDrivers());
  for (const float right : {0.0F, 0.4F, 1.0F}) {
    for (const float left : {0.0F, 0.7F, 1.0F}) {
      FaceState state;
      state.au.right[30] = right;
      state.au.left[30] = left;
      EXPECT_NEAR(WeightOf(*head, 0, state), right, 1e-5F);
      EXPECT_NEAR(WeightOf(*head, 1, state), 0.5F * (right + left), 1e-5F);
      EXPECT_NEAR(WeightOf(*head, 2, state), std::max(right, left), 1e-5F);
      EXPECT_NEAR(WeightOf(*head, 3, state), std::max(right - left, 0.0F), 1e-5F);
    }
  }
}

TEST(MouthFitTest, VisemesComeOutAsTheyAreGivenAndPartsOfThemInPart) {
  FaceState open, round, spread;
  open.mouth = {0.4F, 0, 0.5F, 0, -0.9F, 0, -0.7F, 0, 0, 0, 0, 9};
  round.mouth = {0.3F, 5, 0.4F, 4.5F, -0.6F, 4.5F, -0.5F, 5, -5, 0, 2.2F, 5};
  spread.mouth = {0.6F, -1, 0.8F, -0.9F, -1.4F, -0.9F, -1.1F, -1, 3.5F, 0.5F, -1.2F, 2};
  MouthFit mouth(3);
  mouth.AddViseme(open.mouth, {1, 0, 0});
  mouth.AddViseme(round.mouth, {0, 1, 0});
  mouth.AddViseme(spread.mouth, {0, 0, 1});
  DriveFit fit(3);
  mouth.AddTo(fit, Drive::Kind::kSpokenMouth);
  const auto head = HeadOf(fit.ReleaseDrivers());
  const FaceState* const states[] = {&open, &round, &spread};
  for (std::size_t i = 0; i < 3; ++i) {
    for (const float part : {0.5F, 1.0F}) {
      FaceState state = *states[i];
      for (float& value : state.mouth) value *= part;
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(WeightOf(*head, k, state), k == i ? part : 0, 0.05F) << i << ' ' << k;
      }
      state.mouth_by_hand = state.mouth;
      EXPECT_EQ(WeightOf(*head, i, state), 0) << "this was not spoken";
    }
  }
}

}  // namespace
}  // namespace fsm
