#include "fsm/mesh/transfer/deformation_transfer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <stdexcept>
#include <string>

#include "fsm/base/smooth_step.h"
#include "fsm/head/warp.h"
#include "fsm/mesh/transfer/surface_index.h"
#include "fsm/rig/reach.h"

namespace fsm {
namespace {

/// A vertex of a lip or lid, from which distances along the surface are measured.
struct LipSeed {
  FaceFeature feature;
  std::uint32_t vertex;
};

std::vector<LipSeed> SeedsOf(const WeldedSurface& source, std::span<const PointPair> pairs) {
  std::vector<LipSeed> seeds;
  for (const PointPair& pair : pairs) {
    if (pair.feature != FaceFeature::kNone)
      seeds.push_back({pair.feature, source.Nearest(pair.from)});
  }
  return seeds;
}

/// Returns the seeds of the target for those of the source. On a coarse mesh the vertex nearest to
/// a landmark may belong to the opposite lip, which is avoided in two ways: landmarks are taken
/// where the warp puts them, which averages their errors, and a vertex of the nearest triangle that
/// faces the same way is chosen.
std::vector<LipSeed> SeedsOnTarget(const WeldedSurface& warped, std::span<const LipSeed> seeds,
                                   const WeldedSurface& target) {
  constexpr float kReach = 20;
  const SurfaceIndex index(target, kReach);
  std::vector<LipSeed> found;
  for (const auto& [feature, vertex] : seeds) {
    const auto hit = index.Find(warped, vertex);
    if (!hit) continue;
    const glm::vec3 b = hit->barycentric;
    const std::size_t corner = b.x >= b.y && b.x >= b.z ? 0 : b.y >= b.z ? 1 : 2;
    found.push_back({feature, target.triangles[hit->triangle][corner]});
  }
  return found;
}

/// Marks the lips and lids of a surface by the distances along it from their seeds.
void MarkLipsAndLids(WeldedSurface& surface, std::span<const LipSeed> seeds) {
  const auto mark = [&](FaceFeature upper, FaceFeature lower, float reach, float clear,
                        std::vector<float>& out) {
    std::vector<std::uint32_t> above, below;
    for (const auto& [feature, vertex] : seeds) {
      if (feature == upper) above.push_back(vertex);
      if (feature == lower) below.push_back(vertex);
    }
    if (above.empty() || below.empty()) return;
    const auto up = ShortestPaths(surface.neighbours, surface.position, above, reach).length,
               down = ShortestPaths(surface.neighbours, surface.position, below, reach).length;
    for (std::size_t i = 0; i < out.size(); ++i) {
      // Distances along edges are uncertain by the length of an edge.
      const float nearer = down[i] - up[i];
      if (std::abs(nearer) < surface.MeanEdge(i)) continue;
      const float here = std::clamp(nearer / clear, -1.0f, 1.0f);
      // Vertices farther from the opening are neither upper nor lower.
      out[i] = here * SmoothStep(reach, 0.5f * reach, std::min(up[i], down[i]));
    }
  };
  mark(FaceFeature::kUpperLip, FaceFeature::kLowerLip, 40, 12, surface.lip);
  mark(FaceFeature::kUpperLid, FaceFeature::kLowerLid, 20, 8, surface.lid);
}

/// Diffuses values over a surface: vertices without a weight take the mean of their neighbours.
template <typename T>
void Diffuse(const WeldedSurface& surface, std::vector<T>& value, std::vector<float> weight,
             int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const std::vector<T> old = value;
    const std::vector<float> old_weight = weight;
    for (std::size_t i = 0; i < value.size(); ++i) {
      T sum = old[i] * old_weight[i];
      float total = old_weight[i];
      for (const std::uint32_t j : surface.neighbours[i]) {
        sum += old[j] * old_weight[j];
        total += old_weight[j];
      }
      if (total > 1e-6f) value[i] = sum * (1 / total);
      weight[i] = total / static_cast<float>(surface.neighbours[i].size() + 1);
    }
  }
}

void CheckPlaces(std::span<const PointPair> pairs) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (WithinReach(pairs[i].from) && WithinReach(pairs[i].to)) continue;
    throw std::runtime_error("place " + std::to_string(i + 1) +
                             " of those that both faces have lies farther away than " +
                             kMaxReachOfHead);
  }
}

void CheckVertices(std::span<const glm::vec3> at, const char* whose) {
  const auto lost = std::ranges::find_if_not(at, WithinReach);
  if (lost == at.end()) return;
  throw std::runtime_error("vertex " + std::to_string(lost - at.begin()) + " of " + whose +
                           " lies farther away than " + kMaxReachOfHead);
}

/// Moves the lid edges, and the skin within a few millimetres of them, by the residual of the warp.
/// Lid edges are known more precisely than other landmarks (the skin ends there, at the eyeball),
/// and closing the eye depends on them.
class EdgePull {
 public:
  EdgePull(std::span<const PointPair> pairs, const Warp& warp) {
    for (const PointPair& pair : pairs) {
      if (pair.feature != FaceFeature::kUpperLid && pair.feature != FaceFeature::kLowerLid)
        continue;
      const glm::vec3 at = pair.from + warp.Motion(pair.from);
      left_.push_back({at, pair.to - at});
    }
  }
  glm::vec3 Pulled(glm::vec3 p) const {
    constexpr float kNear = 4;  // millimetres
    glm::vec3 sum(0);
    float total = 0, most = 0;
    for (const WarpPoint& point : left_) {
      const glm::vec3 offset = (p - point.position) / kNear;
      const float weight = Gaussian(glm::dot(offset, offset));
      sum += weight * point.displacement;
      total += weight;
      most = std::max(most, weight);
    }
    return total > 1e-6f ? p + (most / total) * sum : p;
  }

 private:
  std::vector<WarpPoint> left_;
};

/// Returns the positions of a surface after the warp defined by the point pairs.
WeldedSurface Carried(const WeldedSurface& rest, std::span<const PointPair> pairs) {
  std::vector<WarpPoint> points;
  for (const PointPair& pair : pairs) points.push_back({pair.from, pair.to - pair.from});
  // Landmarks have errors of a millimetre or two, and an interpolating warp would tear lids and
  // lips. The warp therefore approximates them, and PullTowards does the rest.
  constexpr float kSmooth = 80;
  const Warp warp(points, kSmooth);
  const EdgePull edges(pairs, warp);
  WeldedSurface carried = rest;
  for (glm::vec3& p : carried.position) p = edges.Pulled(p + warp.Motion(p));
  // Points nearly in one plane do not determine the warp away from it.
  CheckVertices(carried.position, "the face, where the places that both faces have take it,");
  carried.ComputeNormals();
  return carried;
}

/// Moves a surface towards the points of `target` within `reach` millimetres; the movement is
/// smoothed over about `rounds` triangles.
void PullTowards(WeldedSurface& pulled, const WeldedSurface& target, float reach, int rounds) {
  const SurfaceIndex there(target, reach);
  std::vector<glm::vec3> by(pulled.position.size(), glm::vec3(0));
  std::vector<float> weight(pulled.position.size(), 0);
  for (std::size_t i = 0; i < pulled.position.size(); ++i) {
    const auto hit = there.Find(pulled, i);
    if (!hit) continue;
    // Move only along the normal: the landmarks determine the tangential position, and the nearest
    // point, whose triangle changes from round to round, would drift.
    by[i] = glm::dot(hit->position - pulled.position[i], pulled.normal[i]) * pulled.normal[i];
    weight[i] = SmoothStep(reach, 0.4f * reach, hit->distance_mm);
  }
  Diffuse(pulled, by, weight, rounds);
  for (std::size_t i = 0; i < pulled.position.size(); ++i) pulled.position[i] += 0.8f * by[i];
  pulled.ComputeNormals();
}

}  // namespace

DeformationTransfer::DeformationTransfer(const TransferSurface& from, const TransferSurface& to,
                                         std::span<const PointPair> pairs) {
  if (pairs.size() < 8) {
    throw std::runtime_error("at least eight places that both faces have are needed");
  }
  CheckPlaces(pairs);
  CheckVertices(from.position, "the face that is carried");
  CheckVertices(to.position, "the head it is carried to");
  const auto prepared = [](const TransferSurface& face) {
    WeldedSurface surface(face.position, face.triangles, face.has_uv_seams);
    surface.ComputeVisibility(face.position, face.eyes);
    return surface;
  };
  WeldedSurface rest = prepared(from), target = prepared(to);
  const auto seeds = SeedsOf(rest, pairs);
  MarkLipsAndLids(rest, seeds);
  WeldedSurface pulled = Carried(rest, pairs);
  MarkLipsAndLids(target, SeedsOnTarget(pulled, seeds, target));

  // Project the surface onto the other in rounds, from coarse to fine. Necks and backs of heads,
  // which have no landmarks, are far apart at first.
  constexpr std::pair<float, int> kRounds[] = {{30, 40}, {26, 24}, {22, 14},
                                               {18, 8},  {14, 5},  {14, 3}};
  for (const auto& [reach, rounds] : kRounds) PullTowards(pulled, target, reach, rounds);
  MakeRows(Bind(rest, pulled, target), target);
}

std::vector<DeformationTransfer::BarycentricBinding> DeformationTransfer::Bind(
    const WeldedSurface& rest, const WeldedSurface& pulled, const WeldedSurface& target) {
  constexpr float kReach = 20;
  const SurfaceIndex own(pulled, kReach);
  std::vector<BarycentricBinding> bindings(target.position.size());
  std::vector<std::uint32_t> open;
  std::vector<bool> bound(target.position.size(), false);
  for (std::uint32_t w = 0; w < target.position.size(); ++w) {
    const auto hit = own.Find(target, w);
    if (!hit) continue;
    const auto& t = pulled.triangles[hit->triangle];
    bindings[w] = {{rest.given_of[t[0]], rest.given_of[t[1]], rest.given_of[t[2]]},
                   hit->barycentric};
    bound[w] = true;
    open.push_back(w);
  }
  // Vertices that match no point of the source, as in the lining of the mouth, follow their
  // neighbours.
  for (std::size_t k = 0; k < open.size(); ++k) {
    for (const std::uint32_t w : target.neighbours[open[k]]) {
      if (bound[w]) continue;
      bindings[w] = bindings[open[k]];
      bound[w] = true;
      open.push_back(w);
    }
  }
  for (std::size_t w = 0; w < bindings.size(); ++w) {
    if (!bound[w]) bindings[w].barycentric = glm::vec3(0);
  }
  return bindings;
}

void DeformationTransfer::MakeRows(std::span<const BarycentricBinding> bindings,
                                   const WeldedSurface& target) {
  // Neighbours may be bound to distant points, so each vertex is blended with the mean of its
  // neighbours. That smooths differences over a few millimetres; neighbours in a coarse mesh are
  // farther apart.
  constexpr float kMax = 0.25f, kNear = 2.5f;
  rows_.resize(target.welded_of.size());
  std::map<std::uint32_t, float> row;
  const auto add = [&](const BarycentricBinding& binding, float share) {
    for (int c = 0; c < 3; ++c) {
      const float weight = share * binding.barycentric[c];
      if (weight != 0) row[binding.corner[static_cast<std::size_t>(c)]] += weight;
    }
  };
  for (std::size_t v = 0; v < target.welded_of.size(); ++v) {
    const std::uint32_t w = target.welded_of[v];
    if (w == WeldedSurface::kNone) continue;
    const auto& next = target.neighbours[w];
    const float count = std::max(static_cast<float>(next.size()), 1.0f);
    const float near = std::min(1.0f, kNear / std::max(target.MeanEdge(w), 1e-6f));
    const float share = next.empty() ? 0 : kMax * near * near;
    row.clear();
    add(bindings[w], 1 - share);
    for (const std::uint32_t n : next) add(bindings[n], share / count);
    rows_[v].assign(row.begin(), row.end());
  }
}

void DeformationTransfer::Apply(std::span<const glm::vec3> from_by,
                                std::span<glm::vec3> to_by) const {
  for (std::size_t v = 0; v < rows_.size(); ++v) {
    for (const auto& [from, share] : rows_[v]) to_by[v] += share * from_by[from];
  }
}

}  // namespace fsm
