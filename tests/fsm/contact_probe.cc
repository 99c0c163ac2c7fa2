#include "tests/fsm/contact_probe.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fsm::testing {
namespace {

constexpr float kRadians = 0.01745329F;
constexpr float kCorneaForward = 4.99F;  // of its centre from the ball's
constexpr float kCorneaRadius = 8;

std::vector<std::uint32_t> TrianglesOf(Material material) {
  const HeadSurface& topology = GenericHead().surface();
  std::vector<std::uint32_t> found;
  for (const HeadSurface::Part& part : topology.parts) {
    if (part.material != material) continue;
    const auto first = topology.indices.begin() + part.first_index;
    found.insert(found.end(), first, first + part.index_count);
  }
  return found;
}

std::vector<std::uint32_t> VerticesOf(Material material) {
  std::vector<std::uint32_t> found = TrianglesOf(material);
  std::ranges::sort(found);
  const auto same = std::ranges::unique(found);
  found.erase(same.begin(), same.end());
  return found;
}

glm::vec3 CorneaCentre(const FaceState& state, Side side) {
  const float up = -state.gaze[side][kDown] * kRadians;
  const float right = state.gaze[side][kToRight] * kRadians;
  const glm::vec3 gaze(std::cos(up) * std::sin(right), std::sin(up),
                       std::cos(up) * std::cos(right));
  return GenericHead().EyeCentre(side) + kCorneaForward * gaze;
}

/// Pairs of vertices that are one place in `together` and the first above the second in `apart`.
std::vector<std::pair<std::uint32_t, std::uint32_t>> Meeting(
    const std::vector<std::uint32_t>& vertices, const HeadVertices& together,
    const HeadVertices& apart, float near, float off) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const auto a : vertices) {
    for (const auto b : vertices) {
      if (a != b && glm::length(together.position[a] - together.position[b]) < near &&
          apart.position[a].y > apart.position[b].y + off) {
        pairs.emplace_back(a, b);
      }
    }
  }
  std::ranges::sort(pairs, {}, [&](const auto& pair) { return together.position[pair.first].x; });
  return pairs;
}

}  // namespace

ContactProbe::ContactProbe()
    : lips_(VerticesOf(Material::kLip)),
      teeth_(TrianglesOf(Material::kTeeth)),
      tongue_(TrianglesOf(Material::kTongue)) {
  const HeadVertices rest = Vertices({});
  FaceState open;
  open.mouth[kJawY] = 12;
  const HeadVertices opened = Vertices(open);
  seam_ = Meeting(lips_, rest, opened, 1e-3F, 0.3F);

  FaceState blink;
  blink.blink.left = blink.blink.right = 1;
  const HeadVertices shut = Vertices(blink);
  const std::vector<std::uint32_t> skin = VerticesOf(Material::kSkin);
  const std::vector<std::uint32_t> triangles = TrianglesOf(Material::kSkin);
  for (const Side side : kSides) {
    const float radius = GenericHead().surface().eyes[side].ball_radius;
    const glm::vec3 centre = GenericHead().EyeCentre(side);
    for (const auto i : skin) {
      const glm::vec3 d = rest.position[i] - centre;
      const float distance = glm::length(d);
      if (d.z > 5 && distance < radius + 5 && distance > radius + 0.05F) {
        lids_[side].push_back(i);
      }
    }
    rims_[side] = Meeting(lids_[side], shut, rest, 0.1F, 2.0F);
    for (std::size_t k = 0; k < triangles.size(); k += 3) {
      if (glm::length(rest.position[triangles[k]] - centre) > 24) continue;
      lid_triangles_[side].insert(lid_triangles_[side].end(), &triangles[k], &triangles[k] + 3);
    }
  }

  // The edge of a row of teeth: in each millimetre of x its lowest or highest front vertex.
  for (const bool upper : {true, false}) {
    auto& edge = upper ? upper_edge_ : lower_edge_;
    for (int x = -9; x <= 9; ++x) {
      std::uint32_t best = 0;
      float least = 1e9F;
      for (const auto i : teeth_) {
        const glm::vec3& p = rest.position[i];
        const bool of_jaw = std::abs(opened.position[i].y - p.y) > 0.5F;
        if (of_jaw == upper || std::abs(p.x - static_cast<float>(x)) > 0.8F) continue;
        const float height = upper ? p.y : -p.y;
        if (height - 0.001F * p.z < least) {
          least = height - 0.001F * p.z;
          best = i;
        }
      }
      if (least < 1e8F) edge.push_back(best);
    }
  }
}

float ContactProbe::TeethInLips(const HeadVertices& v) const {
  // Front faces of the teeth as heights over a grid of millimetres.
  constexpr int kSide = 160;
  constexpr int kMiddle = kSide / 2;
  static thread_local std::vector<float> front;
  front.assign(kSide * kSide, -1e9F);
  const auto cell = [](const glm::vec3& p) {
    const int x = static_cast<int>(std::floor(p.x)) + kMiddle;
    const int y = static_cast<int>(std::floor(p.y)) + kMiddle + 40;
    return x >= 0 && x < kSide && y >= 0 && y < kSide ? y * kSide + x : -1;
  };
  for (std::size_t k = 0; k < teeth_.size(); k += 3) {
    const glm::vec3 &a = v.position[teeth_[k]], &b = v.position[teeth_[k + 1]],
                    &c = v.position[teeth_[k + 2]];
    if (glm::cross(b - a, c - a).z <= 0) continue;
    const glm::vec3 m = (a + b + c) / 3.0F;
    if (const int at = cell(m); at >= 0) {
      float& z = front[static_cast<std::size_t>(at)];
      z = std::max(z, m.z);
    }
  }
  float worst = 0;
  for (const auto i : lips_) {
    if (v.normal[i].z < 0.3F) continue;  // only what is seen
    if (const int at = cell(v.position[i]); at >= 0) {
      worst = std::max(worst, front[static_cast<std::size_t>(at)] - v.position[i].z);
    }
  }
  return worst;
}

float ContactProbe::TongueAcross(const std::vector<glm::vec3>& line, float up,
                                 const HeadVertices& v) const {
  // Where the tongue's surface passes the depth of the line. Not judged beside the line's ends.
  float worst = 0;
  const auto at = [&line](float x) {
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      if (x < line[k].x || x >= line[k + 1].x) continue;
      return glm::mix(line[k], line[k + 1], (x - line[k].x) / (line[k + 1].x - line[k].x));
    }
    return glm::vec3(0, 0, 1e9F);
  };
  for (std::size_t k = 0; k < tongue_.size(); k += 3) {
    for (std::size_t e = 0; e < 3; ++e) {
      const glm::vec3 a = v.position[tongue_[k + e]], b = v.position[tongue_[k + (e + 1) % 3]];
      const float za = a.z - at(a.x).z;
      const float zb = b.z - at(b.x).z;
      if (za < -1e8F || zb < -1e8F || (za < 0) == (zb < 0)) continue;
      const glm::vec3 p = glm::mix(a, b, za / (za - zb));
      const glm::vec3 edge = at(p.x);
      if (edge.z < 1e8F) worst = std::max(worst, up * (p.y - edge.y));
    }
  }
  return worst;
}

Contacts ContactProbe::Measure(const FaceState& state, const HeadVertices& v) const {
  Contacts out;
  for (const auto& [a, b] : seam_) {
    out.lips = std::max(out.lips, v.position[b].y - v.position[a].y);
  }
  for (const Side side : kSides) {
    for (const auto& [a, b] : rims_[side]) {
      out.lids = std::max(out.lids, v.position[b].y - v.position[a].y);
    }
    const float radius = GenericHead().surface().eyes[side].ball_radius;
    const glm::vec3 centre = GenericHead().EyeCentre(side);
    const glm::vec3 cornea = CorneaCentre(state, side);
    for (const auto i : lids_[side]) {
      out.ball_in_lids = std::max({out.ball_in_lids, radius - glm::length(v.position[i] - centre),
                                   kCorneaRadius - glm::length(v.position[i] - cornea)});
    }
  }
  out.teeth_in_lips = TeethInLips(v);
  std::array<std::vector<glm::vec3>, 4> lines;  // of both lips, of both rows of teeth
  for (const auto& [a, b] : seam_) {
    lines[0].push_back(v.position[a]);
    lines[1].push_back(v.position[b]);
  }
  for (const auto i : upper_edge_) lines[2].push_back(v.position[i]);
  for (const auto i : lower_edge_) lines[3].push_back(v.position[i]);
  out.tongue_in_lips = std::max(TongueAcross(lines[0], 1, v), TongueAcross(lines[1], -1, v));
  out.tongue_in_teeth = std::max(TongueAcross(lines[2], 1, v), TongueAcross(lines[3], -1, v));
  return out;
}

float ContactProbe::Uncovered(const FaceState& state, const HeadVertices& v) const {
  float worst = 0;
  for (const Side side : kSides) {
    const float radius = GenericHead().surface().eyes[side].ball_radius;
    const glm::vec3 centre = GenericHead().EyeCentre(side);
    const glm::vec3 cornea = CorneaCentre(state, side);
    const auto front_of = [](const glm::vec3& middle, float size, float x, float y) {
      const float dx = x - middle.x, dy = y - middle.y;
      const float left = size * size - dx * dx - dy * dy;
      return left > 0 ? middle.z + std::sqrt(left) : -1e9F;
    };
    const auto& triangles = lid_triangles_[side];
    for (float x = centre.x - 10; x <= centre.x + 10; x += 1.25F) {
      for (float y = centre.y - 6; y <= centre.y + 6; y += 1.25F) {
        const float ball =
            std::max(front_of(centre, radius, x, y), front_of(cornea, kCorneaRadius, x, y));
        float skin = -1e9F;
        for (std::size_t k = 0; k < triangles.size(); k += 3) {
          const glm::vec3 &a = v.position[triangles[k]], &b = v.position[triangles[k + 1]],
                          &c = v.position[triangles[k + 2]];
          const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
          if (area <= 1e-6F) continue;
          const float wa = ((b.x - x) * (c.y - y) - (b.y - y) * (c.x - x)) / area;
          const float wb = ((c.x - x) * (a.y - y) - (c.y - y) * (a.x - x)) / area;
          if (wa < -1e-3F || wb < -1e-3F || wa + wb > 1.001F) continue;
          skin = std::max(skin, wa * a.z + wb * b.z + (1 - wa - wb) * c.z);
        }
        if (ball > -1e8F) worst = std::max(worst, ball - skin);
      }
    }
  }
  return worst;
}

}  // namespace fsm::testing
