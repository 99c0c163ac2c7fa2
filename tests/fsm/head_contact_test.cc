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
using testing::RandomState;
using testing::SeamPairs;
using testing::Vertices;
using testing::WithUnit;

/// The deepest crossing of the lips in millimetres.
float LipCrossing(const HeadVertices& v,
                  const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  float worst = 0;
  for (const auto& [a, b] : pairs) worst = std::max(worst, v.position[b].y - v.position[a].y);
  return worst;
}

/// Front faces of the teeth as heights z over a grid of x and y; how far lip vertices lie behind.
float TeethThroughLips(const HeadVertices& v) {
  const HeadSurface& topology = GenericHead().surface();
  std::map<std::pair<int, int>, float> front;  // 1 mm cells
  const auto cell = [](glm::vec3 p) {
    return std::pair{static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y))};
  };
  std::vector<std::uint32_t> lips;
  for (const HeadSurface::Part& part : topology.parts) {
    const std::uint32_t* first = &topology.indices[part.first_index];
    if (part.material == Material::kLip) lips.insert(lips.end(), first, first + part.index_count);
    if (part.material != Material::kTeeth) continue;
    for (std::uint32_t k = 0; k < part.index_count; k += 3) {
      const glm::vec3 a = v.position[first[k]], b = v.position[first[k + 1]],
                      c = v.position[first[k + 2]];
      if (glm::cross(b - a, c - a).z <= 0) continue;
      const glm::vec3 m = (a + b + c) / 3.0f;
      const auto [entry, fresh] = front.try_emplace(cell(m), m.z);
      if (!fresh) entry->second = std::max(entry->second, m.z);
    }
  }
  float worst = 0;
  for (const std::uint32_t i : lips) {
    if (v.normal[i].z < 0.3f) continue;  // only what is seen
    const auto found = front.find(cell(v.position[i]));
    if (found != front.end()) worst = std::max(worst, found->second - v.position[i].z);
  }
  return worst;
}

TEST(HeadContactTest, LipsDoNotCrossInAnySingleUnitOrPair) {
  const auto pairs = SeamPairs();
  ASSERT_GE(pairs.size(), 15u);
  for (std::size_t a = 1; a < kActionUnits; ++a) {
    for (std::size_t b = a; b < kActionUnits; ++b) {
      FaceState state = WithUnit(a, 1);
      state.au.left[b] = state.au.right[b] = 1;
      ASSERT_LE(LipCrossing(Vertices(state), pairs), 0.3f) << "AU " << a << " and " << b;
    }
  }
}

TEST(HeadContactTest, LipsDoNotCrossInTenThousandRandomStates) {
  const auto pairs = SeamPairs();
  std::mt19937 random(17);
  for (int i = 0; i < 10000; ++i) {
    ASSERT_LE(LipCrossing(Vertices(RandomState(random, 1.5f)), pairs), 0.3f) << "state " << i;
  }
}

TEST(HeadContactTest, EveryIdentityClosesItsEyes) {
  for (const std::string& identity : Identities()) {
    const auto head = MakeHead(identity);
    FaceState blink;
    blink.blink.left = blink.blink.right = 1;
    HeadVertices v;
    head->Evaluate(blink, v);
    const HeadSurface& topology = head->surface();
    const glm::vec3 pupil = head->EyeCentre(Side::kLeft) + glm::vec3(0, 0, 13.2f);
    for (const glm::vec2 off : {glm::vec2(0, 0), {6, 0}, {-6, 1}, {0, 4}, {0, -4}, {3, 3}}) {
      const glm::vec2 p(pupil.x + off.x, pupil.y + off.y);
      bool covered = false;
      for (const HeadSurface::Part& part : topology.parts) {
        if (part.material != Material::kSkin) continue;
        for (std::uint32_t k = 0; k < part.index_count && !covered; k += 3) {
          const std::uint32_t* i = &topology.indices[part.first_index + k];
          const glm::vec3 a = v.position[i[0]], b = v.position[i[1]], c = v.position[i[2]];
          const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
          if (area <= 1e-6f) continue;
          const float wa = ((b.x - p.x) * (c.y - p.y) - (b.y - p.y) * (c.x - p.x)) / area;
          const float wb = ((c.x - p.x) * (a.y - p.y) - (c.y - p.y) * (a.x - p.x)) / area;
          if (wa < -1e-3f || wb < -1e-3f || wa + wb > 1.001f) continue;
          const float reach = glm::length(off) / 12;
          covered = wa * a.z + wb * b.z + (1 - wa - wb) * c.z >
                    pupil.z - 13.2f + 12 * std::sqrt(1 - reach * reach);
        }
      }
      EXPECT_TRUE(covered) << identity << " " << off.x << " " << off.y;
    }
  }
}

TEST(HeadContactTest, TeethStayBehindTheLips) {
  for (std::size_t a = 1; a < kActionUnits; ++a) {
    for (const std::size_t b : {a, std::size_t{12}, std::size_t{26}, std::size_t{25}}) {
      FaceState state = WithUnit(a, 1);
      state.au.left[b] = state.au.right[b] = 1;
      EXPECT_LE(TeethThroughLips(Vertices(state)), 0.3f) << "AU " << a << " and " << b;
    }
  }
  std::mt19937 random(23);
  int through = 0;
  for (int i = 0; i < 1000; ++i) {
    through += TeethThroughLips(Vertices(RandomState(random, 1))) > 0.3f ? 1 : 0;
  }
  EXPECT_EQ(through, 0);
}

TEST(HeadContactTest, LidsStayOutsideTheEyeball) {
  // Lid vertices are those of the skin within 5 mm of the ball's front at rest. Neither ball nor
  // cornea comes more than 0.3 mm through them, wherever the eye looks and however far they close.
  const HeadSurface& topology = GenericHead().surface();
  const HeadVertices rest = Vertices({});
  const float radius = topology.eyes.left.ball_radius;
  const glm::vec3 centre = GenericHead().EyeCentre(Side::kLeft);
  std::vector<std::uint32_t> lids;
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material != Material::kSkin) continue;
    for (std::uint32_t k = 0; k < part.index_count; ++k) {
      const std::uint32_t i = topology.indices[part.first_index + k];
      const glm::vec3 d = rest.position[i] - centre;
      if (d.z > 5 && glm::length(d) < radius + 5 && glm::length(d) > radius + 0.05f) {
        lids.push_back(i);
      }
    }
  }
  ASSERT_GT(lids.size(), 100u);
  std::mt19937 random(31);
  std::uniform_real_distribution<float> turn(-30, 30);
  std::uniform_real_distribution<float> part(0, 1);
  for (int n = 0; n < 1000; ++n) {
    FaceState state = RandomState(random, 1);
    state.gaze.left = {-turn(random), turn(random)};
    state.blink.left = part(random);
    const HeadVertices v = Vertices(state);
    const float up = -state.gaze.left[kDown] * 0.0174533f;
    const float right = state.gaze.left[kToRight] * 0.0174533f;
    const glm::vec3 gaze(std::cos(up) * std::sin(right), std::sin(up),
                         std::cos(up) * std::cos(right));
    const glm::vec3 cornea = centre + 4.99f * gaze;
    for (const std::uint32_t i : lids) {
      ASSERT_GE(glm::length(v.position[i] - centre), radius - 0.3f) << "state " << n;
      ASSERT_GE(glm::length(v.position[i] - cornea), 8 - 0.3f) << "state " << n;
    }
  }
}

TEST(HeadContactTest, NoTriangleOfTheFaceTurnsOver) {
  // Against its direction at rest, judged by the angle of its normal; folds of the lids may turn on
  // the ball, the inside of the mouth may not be seen.
  for (const char* name : {"galatea", "pygmalion"}) {
    const auto head = MakeSymmetricHead(name);
    const HeadSurface& topology = head->surface();
    HeadVertices rest, v;
    head->Evaluate({}, rest);
    for (std::size_t unit = 1; unit < kActionUnits; ++unit) {
      head->Evaluate(WithUnit(unit, 1), v);
      int turned = 0;
      glm::vec3 at(0);
      for (const HeadSurface::Part& part : topology.parts) {
        if (part.material != Material::kSkin) continue;
        for (std::uint32_t k = 0; k < part.index_count; k += 3) {
          const std::uint32_t* i = &topology.indices[part.first_index + k];
          const auto normal = [&](const HeadVertices& h) {
            return glm::cross(h.position[i[1]] - h.position[i[0]],
                              h.position[i[2]] - h.position[i[0]]);
          };
          const glm::vec3 a = normal(rest);
          const glm::vec3 b = normal(v);
          if (glm::length(a) < 0.05f || glm::length(b) < 0.05f) continue;
          // Near the eyes lids turn with the ball, by up to a right angle.
          if (glm::dot(glm::normalize(a), glm::normalize(b)) >= -0.35f) continue;
          ++turned;
          at = rest.position[i[0]];
        }
      }
      EXPECT_EQ(turned, 0) << name << ", AU " << unit << ", at " << at.x << ' ' << at.y << ' '
                           << at.z;
    }
  }
}

TEST(HeadContactTest, EvaluationIsDeterministic) {
  std::mt19937 random(5);
  const FaceState state = RandomState(random, 1);
  EXPECT_EQ(Vertices(state).position, Vertices(state).position);
}

}  // namespace
}  // namespace fsm
