// What hangs on springs: how it swings, that it swings alike however often it is looked at, and
// what of a head it moves.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fsm/base/table_reader.h"
#include "fsm/head/hair_springs.h"
#include "fsm/head/identity.h"
#include "fsm/head/make_head.h"
#include "fsm/rig/head.h"
#include "fsm/rig/simulation.h"
#include "tests/support/still_rig.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;
using Time = Simulation::Time;

FaceState Turned(float down, float right, float tilt) {
  FaceState state;
  state.head_rotation = {down, right, tilt};
  return state;
}

/// Turns 30 degrees to the viewer's right within 200 ms from 4 s on.
FaceState TurnAt4s(Time t) {
  const auto ms = static_cast<float>((t - 4s) / 1ms);
  return Turned(0, 30 * std::clamp(ms / 200, 0.0f, 1.0f), 0);
}

/// At the right ear, 10 cm below what it hangs from.
Spring AtEar() {
  return {.rest = {-80, -60, -10}, .root = {-80, 40, -10}, .frequency_hz = 2, .damping = 0.2f};
}

TEST(SimulationTest, UnderAHeadThatStandsStillNothingSwings) {
  Simulation simulation({AtEar()});
  for (Time t = 0ms; t < 2s; t += 33ms) {
    simulation.RunTo(t, [](Time) { return Turned(0, 20, 0); });
    EXPECT_LT(glm::length(simulation.offsets()[0]), 1e-4f);
    EXPECT_TRUE(simulation.Still());
  }
}

TEST(SimulationTest, ATurnLeavesSpringsBehindThenThrowsThemBeyondUntilTheyRest) {
  Simulation simulation({AtEar()});
  simulation.RunTo(4s, TurnAt4s);
  // The right ear goes forward, +z.
  simulation.RunTo(4100ms, TurnAt4s);
  EXPECT_LT(simulation.offsets()[0].z, -5);
  EXPECT_FALSE(simulation.Still());
  simulation.RunTo(4350ms, TurnAt4s);
  EXPECT_GT(simulation.offsets()[0].z, 2);
  simulation.RunTo(8s, TurnAt4s);
  EXPECT_LT(glm::length(simulation.offsets()[0]), 0.01f);
  EXPECT_TRUE(simulation.Still());
}

TEST(SimulationTest, SwingsAtItsFrequencyAndFadesByItsDamping) {
  Spring spring = AtEar();
  spring.reach_mm = 1000;
  Simulation simulation({spring});
  simulation.RunTo(4s, TurnAt4s);
  std::vector<float> peaks;
  std::vector<Time> crossings;
  float last = 0, peak = 0;
  for (Time t = 4250ms; t < 7s; t += 1ms) {
    simulation.RunTo(t, TurnAt4s);
    const float now = simulation.offsets()[0].z;
    peak = std::max(peak, std::abs(now));
    if (last * now < 0) {
      crossings.push_back(t);
      peaks.push_back(std::exchange(peak, 0.0f));
    }
    last = now;
  }
  ASSERT_GE(crossings.size(), 4u);
  const double half_period = 1 / (2 * 2 * std::sqrt(1 - 0.2 * 0.2));  // seconds
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_NEAR(static_cast<double>((crossings[i] - crossings[i - 1]) / 1ms), 1000 * half_period,
                2);
  }
  const double fade = std::exp(-0.2 * std::numbers::pi / std::sqrt(1 - 0.2 * 0.2));
  EXPECT_NEAR(static_cast<double>(peaks[2] / peaks[1]), fade, 0.02);
}

TEST(SimulationTest, HowOftenItIsLookedAtChangesNothing) {
  Simulation often({AtEar()}), seldom({AtEar()}), unevenly({AtEar()});
  for (Time t = 3500ms; t < 4600ms; t += 7ms) often.RunTo(t, TurnAt4s);
  for (Time t = 3500ms; t < 4600ms; t += 331ms) unevenly.RunTo(t, TurnAt4s);
  for (Simulation* one : {&often, &seldom, &unevenly}) one->RunTo(4600ms, TurnAt4s);
  EXPECT_GT(glm::length(seldom.offsets()[0]), 0.5f);
  EXPECT_EQ(often.offsets()[0], seldom.offsets()[0]);
  EXPECT_EQ(unevenly.offsets()[0], seldom.offsets()[0]);
}

TEST(SimulationTest, BackInTimeAndAfterALongPauseItBeginsAnew) {
  Simulation again({AtEar()}), first({AtEar()});
  again.RunTo(100s, TurnAt4s);
  again.RunTo(4150ms, TurnAt4s);
  first.RunTo(4150ms, TurnAt4s);
  EXPECT_EQ(again.offsets()[0], first.offsets()[0]);
  std::size_t asked = 0;
  again.RunTo(24h, [&](Time t) {
    ++asked;
    EXPECT_GE(t, 24h - Simulation::kMemory - 10ms);
    return FaceState{};
  });
  EXPECT_LT(asked, 400u);
}

TEST(SimulationTest, WhateverTheHeadDoesOffsetsStayWithinTheirLimit) {
  Spring stiff = AtEar(), loose = AtEar();
  stiff.frequency_hz = Spring::kMaxHz;
  loose.frequency_hz = Spring::kMinHz;
  loose.damping = Spring::kMinDamping;
  Simulation simulation({stiff, loose});
  const auto wild = [](Time t) {
    FaceState state = Turned((t / 10ms) % 2 == 0 ? 1e9f : -1e9f, std::nanf(""), 500);
    state.head_forward_mm = std::numeric_limits<float>::infinity();
    return state;
  };
  for (Time t = 0ms; t < 60s; t += 40ms) {
    simulation.RunTo(t, wild);
    for (const glm::vec3 offset : simulation.offsets()) ASSERT_LE(glm::length(offset), 20.001f);
  }
}

TEST(SimulationTest, NothingSwingsIntoWhatItLiesOn) {
  Spring spring = AtEar();
  spring.outward = {-1, 0, 0};
  spring.hang = 1;
  Simulation simulation({spring});
  const auto shaken = [](Time t) {
    return Turned(0, 0, 30 * std::sin(static_cast<float>(t / 1ms) / 100));
  };
  bool left = false;
  for (Time t = 0ms; t < 3s; t += 10ms) {
    simulation.RunTo(t, shaken);
    const float lean = -shaken(t).head_rotation[2] * std::numbers::pi_v<float> / 180;
    const glm::vec3 outward{-std::cos(lean), -std::sin(lean), 0};
    EXPECT_GT(glm::dot(simulation.offsets()[0], outward), -1e-3f);
    left = left || glm::dot(simulation.offsets()[0], outward) > 5;
  }
  EXPECT_TRUE(left);
}

TEST(SimulationTest, WhatHangsGoesStraightDownAsTheHeadLeans) {
  Spring spring = AtEar();
  spring.hang = 1;
  spring.reach_mm = 1e6f;
  Simulation simulation({spring});
  const auto leaning = [](Time) { return Turned(0, 40, 20); };
  simulation.RunTo(5s, leaning);
  RigData still = support::MakeStillRig({spring.rest, spring.root}, {{0, 0, 1}, {0, 0, 1}});
  still.steps = {RigStep::kNeck};
  HeadVertices carried;
  Rig(still).Evaluate(leaning(5s), carried);
  const glm::vec3 hangs = carried.position[0] + simulation.offsets()[0] - carried.position[1];
  EXPECT_NEAR(hangs.x, 0, 0.01f);
  EXPECT_NEAR(hangs.z, 0, 0.01f);
  EXPECT_NEAR(hangs.y, -100, 0.01f);
}

TEST(HairSpringsTest, LongHairSwingsAndNothingElseDoes) {
  const auto head = MakeHead("galatea");
  const RigData& rig = head->rig().data();
  ASSERT_FALSE(rig.spring_rig.springs.empty());
  std::set<std::uint32_t> hair;
  for (const auto& part : head->surface().parts) {
    if (part.material != Material::kHair) continue;
    for (std::uint32_t k = 0; k < part.index_count; ++k)
      hair.insert(head->surface().indices[part.first_index + k]);
  }
  HeadVertices still, swung;
  head->Evaluate({}, still);
  const std::vector<glm::vec3> offsets(rig.spring_rig.springs.size(), glm::vec3(3, 0, 0));
  head->Evaluate({}, swung, offsets);
  std::size_t moved = 0;
  for (std::uint32_t v = 0; v < still.position.size(); ++v) {
    const float by = glm::distance(still.position[v], swung.position[v]);
    EXPECT_LE(by, 3.001f);
    if (by == 0) continue;
    EXPECT_TRUE(hair.contains(v)) << v;
    EXPECT_LT(still.position[v].y, 6) << "hair on the skull stands still";
    moved += by > 2.9f ? 1 : 0;
  }
  EXPECT_GT(moved, 200u);
  EXPECT_TRUE(MakeHead("pygmalion")->rig().data().spring_rig.springs.empty());
}

TEST(HairSpringsTest, OfTiedHairOnlyTheTailAndLooseStrandsSwing) {
  const auto head = MakeHead(ReadOwnIdentity("i.txt", "base zhenzhen\nhair tied 4 8 58 -125 6\n"));
  const RigData& rig = head->rig().data();
  ASSERT_FALSE(rig.spring_rig.weights.empty());
  for (const auto& [vertex, spring, weight] : rig.spring_rig.weights) {
    const glm::vec3 p = rig.rest[vertex];
    EXPECT_TRUE(p.z < -85 || p.z > 20) << "lies on the head: " << p.x << " " << p.y << " " << p.z;
  }
  const auto swept = MakeHead(ReadOwnIdentity("i.txt", "base baucis\nhair swept 10 19 3.5 0.9\n"));
  EXPECT_TRUE(swept->rig().data().spring_rig.springs.empty());
}

TEST(HairSpringsTest, NeighboursGoAlong) {
  // No edge of the hair tears: vertices of a triangle swing nearly alike.
  const auto head = MakeHead("galatea");
  Simulation simulation(head->rig().data().spring_rig.springs);
  const auto shaken = [](Time t) {
    return Turned(0, 25 * std::sin(static_cast<float>(t / 1ms) / 120), 0);
  };
  HeadVertices vertices, still;
  const auto& topology = head->surface();
  for (Time t = 0ms; t < 2s; t += 90ms) {
    simulation.RunTo(t, shaken);
    head->Evaluate(shaken(t), still);
    head->Evaluate(shaken(t), vertices, simulation.offsets());
    for (std::size_t k = 0; k + 1 < topology.indices.size(); ++k) {
      if (k % 3 == 2) continue;
      const std::uint32_t a = topology.indices[k], b = topology.indices[k + 1];
      const float before = glm::distance(still.position[a], still.position[b]);
      const float after = glm::distance(vertices.position[a], vertices.position[b]);
      ASSERT_LT(std::abs(after - before), 4 + 0.5f * before) << a << " " << b;
    }
  }
}

TEST(HairSpringsTest, TheTableRefusesNonsenseByFileAndLine) {
  const auto complaint = [](const std::string& rows) -> std::string {
    RigData rig = support::MakeStillRig({{0, -50, 80}}, {{0, 0, 1}});
    try {
      AddHairSprings(Table("hair.txt", "axis 0 0\naround 8\nstill 0\n" + rows), 0, rig);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return rig.spring_rig.springs.empty() ? "no springs" : "";
  };
  EXPECT_EQ(complaint("row -40 2 0.3 0.5 20\n"), "");
  EXPECT_EQ(complaint(""), "no springs");
  EXPECT_EQ(complaint("row -40 31 0.3 0.5 20\n"),
            "hair.txt:4: '31' found where 0.1 to 30 was expected");
  EXPECT_EQ(complaint("row -40 2 1 0.5 20\n"),
            "hair.txt:4: '1' found where 0.01 to 0.99 was expected");
  EXPECT_EQ(complaint("row 1 2 0.3 0.5 20\n"),
            "hair.txt:4: '1' found where -1000 to -1 was expected");
  EXPECT_EQ(complaint("row -40 2 0.3 0.5 20\nrow -40 2 0.3 0.5 20\n"),
            "hair.txt:5: '-40' found where -1000 to -41 was expected");
  EXPECT_EQ(complaint("row -40 2 0.3 0.5\n"),
            "hair.txt:4: 'row' needs at least 5 values after it, found 4");
}

}  // namespace
}  // namespace fsm
