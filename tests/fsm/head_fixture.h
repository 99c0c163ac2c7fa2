#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "fsm/head/make_head.h"
#include "fsm/rig/head.h"

namespace fsm::testing {

/// Making the head takes some 50 ms, so all tests of a program share one.
inline const Head& GenericHead() {
  static const std::unique_ptr<Head> head = MakeSymmetricHead("galatea");
  return *head;
}

inline HeadVertices Vertices(const FaceState& state) {
  HeadVertices out;
  GenericHead().Evaluate(state, out);
  return out;
}

inline FaceState WithUnit(std::size_t unit, float strength) {
  FaceState state;
  state.au.left[unit] = state.au.right[unit] = strength;
  return state;
}

/// The vertex of the skin or lips at the front of the face nearest to (x, y) at rest.
inline std::size_t SkinAt(float x, float y) {
  const HeadSurface& topology = GenericHead().surface();
  static const HeadVertices rest = Vertices({});
  std::size_t best = 0;
  float least = std::numeric_limits<float>::max();
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material != Material::kSkin && part.material != Material::kLip) continue;
    for (std::uint32_t k = 0; k < part.index_count; ++k) {
      const std::size_t i = topology.indices[part.first_index + k];
      const glm::vec3 p = rest.position[i];
      if (p.z < 40 || rest.normal[i].z < 0.2f) continue;
      const float d = (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);
      if (d < least) {
        least = d;
        best = i;
      }
    }
  }
  return best;
}

/// How far the skin at (x, y) moves from rest in `state`.
inline glm::vec3 MotionAt(float x, float y, const FaceState& state) {
  static const HeadVertices rest = Vertices({});
  const std::size_t i = SkinAt(x, y);
  return Vertices(state).position[i] - rest.position[i];
}

/// Pairs of lip vertices that share a place at rest: above and below the seam.
inline std::vector<std::pair<std::size_t, std::size_t>> SeamPairs() {
  const HeadSurface& topology = GenericHead().surface();
  const HeadVertices rest = Vertices({});
  FaceState open;
  open.mouth[kJawY] = 12;
  const HeadVertices opened = Vertices(open);
  std::vector<std::size_t> lips;
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material != Material::kLip) continue;
    lips.insert(lips.end(), &topology.indices[part.first_index],
                &topology.indices[part.first_index] + part.index_count);
  }
  std::ranges::sort(lips);
  lips.erase(std::ranges::unique(lips).begin(), lips.end());
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const std::size_t a : lips) {
    for (const std::size_t b : lips) {
      if (a != b && glm::length(rest.position[a] - rest.position[b]) < 1e-3f &&
          opened.position[a].y > opened.position[b].y + 0.3f) {
        pairs.emplace_back(a, b);
      }
    }
  }
  return pairs;
}

inline FaceState RandomState(std::mt19937& random, float strength) {
  std::uniform_real_distribution<float> unit(0, strength);
  std::uniform_real_distribution<float> offset(-5, 5);
  std::uniform_int_distribution<int> chance(0, 5);
  FaceState state;
  for (std::size_t i = 1; i < kActionUnits; ++i) {
    if (chance(random) == 0) state.au.left[i] = unit(random);
    if (chance(random) == 0) state.au.right[i] = unit(random);
  }
  for (float& m : state.mouth) m = chance(random) < 3 ? offset(random) : 0;
  return state;
}

}  // namespace fsm::testing
