#include "fsm/render/coarse_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <map>
#include <span>
#include <utility>

#include "fsm/render/vertex_features.h"

namespace fsm {
namespace {

bool Has(const auto& range, std::uint32_t value) {
  return std::ranges::find(range, value) != std::ranges::end(range);
}

glm::vec3 Cross(const VertexFeatures& features, const std::array<std::uint32_t, 3>& t) {
  const glm::vec3 a = features.RestOf(t[0]);
  return glm::cross(features.RestOf(t[1]) - a, features.RestOf(t[2]) - a);
}

/// A part of a head's mesh that loses vertices one by one: each is drawn onto one beside it (a
/// half-edge collapse, after Kobbelt, Campagna and Seidel 1998, "A general framework for mesh
/// decimation"), so that those that stay are where they were.
class PartDecimator {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  /// `open`: vertices of its border may go, too, along the border.
  PartDecimator(const VertexFeatures& features, std::span<const std::uint32_t> corners, bool open)
      : features_(features), open_(open) {
    std::map<std::uint32_t, std::uint32_t> own;
    for (std::size_t k = 0; k + 2 < corners.size(); k += 3) {
      Triangle triangle{};
      for (std::size_t c = 0; c < 3; ++c) {
        const auto [found, fresh] =
            own.try_emplace(corners[k + c], static_cast<std::uint32_t>(vertices_.size()));
        if (fresh) vertices_.emplace_back().number = corners[k + c];
        triangle[c] = found->second;
        vertices_[found->second].triangles.push_back(static_cast<std::uint32_t>(triangles_.size()));
      }
      triangles_.push_back(triangle);
    }
    left_out_.resize(triangles_.size());
    gone_.resize(triangles_.size());
  }

  void Shrink(float error) {
    bool any = true;
    const std::uint32_t first_pass = pass_ + 1;
    while (std::exchange(any, false)) {
      ++pass_;
      for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
        Vertex& vertex = vertices_[v];
        if (vertex.triangles.empty()) continue;
        if (vertex.tried_at >= std::max(first_pass, vertex.changed_at)) continue;
        // A vertex that has lost a neighbour waits for the next pass, so that vertices go evenly.
        if (vertex.changed_at > pass_) {
          any = true;
          continue;
        }
        vertex.tried_at = pass_;
        Ring ring = RingOf(v);
        if (!MayGo(ring)) continue;
        // Short edges first, so that no slivers come about.
        std::ranges::sort(ring.around, {}, [&](std::uint32_t w) {
          return std::pair(
              glm::distance(features_.RestOf(vertex.number), features_.RestOf(vertices_[w].number)),
              w);
        });
        const auto to = std::ranges::find_if(
            ring.around, [&](std::uint32_t w) { return Fits(v, w, ring, error); });
        if (to == ring.around.end()) continue;
        Collapse(v, *to);
        for (const auto w : ring.around) vertices_[w].changed_at = pass_ + 1;
        any = true;
      }
    }
  }

  void Append(std::vector<std::uint32_t>& out) const {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (gone_[t]) continue;
      for (const auto corner : triangles_[t]) out.push_back(vertices_[corner].number);
    }
  }

 private:
  struct Vertex {
    std::uint32_t number = 0;              // in the head
    std::vector<std::uint32_t> triangles;  // that it is a corner of
    std::uint32_t tried_at = 0;            // the pass in which it was last found to be needed
    std::uint32_t changed_at = 0;          // and the first after something beside it changed
  };
  struct Ring {
    std::vector<std::uint32_t> around;  // neighbours
    std::vector<std::uint32_t> ends;    // those to which it is joined by the border
  };

  Ring RingOf(std::uint32_t v) const {
    std::vector<std::uint32_t> seen;
    for (const auto t : vertices_[v].triangles) {
      for (const auto corner : triangles_[t]) {
        if (corner != v) seen.push_back(corner);
      }
    }
    std::ranges::sort(seen);
    Ring ring;
    for (std::size_t i = 0; i < seen.size();) {
      std::size_t next = i;
      while (next < seen.size() && seen[next] == seen[i]) ++next;
      ring.around.push_back(seen[i]);
      // Where more than two triangles meet at an edge both of its ends stay.
      if (next - i != 2) ring.ends.insert(ring.ends.end(), next - i == 1 ? 1 : 3, seen[i]);
      i = next;
    }
    return ring;
  }

  bool MayGo(const Ring& ring) const {
    return ring.ends.empty() || (open_ && ring.ends.size() == 2);
  }
  /// Whether `v` may be drawn onto `to`; then `after_` says what becomes of its triangles.
  bool Fits(std::uint32_t v, std::uint32_t to, const Ring& ring, float error) {
    const bool on_border = !ring.ends.empty();
    if (on_border && !Has(ring.ends, to)) return false;
    after_.clear();
    moved_.clear();
    for (const auto t : vertices_[v].triangles) {
      Triangle triangle = triangles_[t];
      if (Has(triangle, to)) continue;
      const auto numbers = [this](const Triangle& of) {
        return Triangle{vertices_[of[0]].number, vertices_[of[1]].number, vertices_[of[2]].number};
      };
      const glm::vec3 before = Cross(features_, numbers(triangle));
      std::ranges::replace(triangle, v, to);
      const glm::vec3 now = Cross(features_, numbers(triangle));
      if (glm::dot(before, now) < 0.3F * glm::length(before) * glm::length(now)) return false;
      after_.emplace_back(t, triangle);
    }
    std::size_t where = 0;
    const auto settle = [&](std::uint32_t vertex) {
      if (!Settle(vertex, error, where)) return false;
      moved_.emplace_back(vertex, after_[where].first);
      return true;
    };
    if (!settle(vertices_[v].number)) return false;
    // More common neighbours than triangles at the edge: the surface would be pinched.
    const Ring other = RingOf(to);
    const auto common = std::ranges::count_if(
        other.around, [&ring](std::uint32_t w) { return Has(ring.around, w); });
    if (common != (on_border ? 1 : 2)) return false;
    return std::ranges::all_of(vertices_[v].triangles, [&](std::uint32_t t) {
      return std::ranges::all_of(left_out_[t], settle);
    });
  }

  /// The one of `after_` on which a vertex is shown best; none if the error is greater.
  bool Settle(std::uint32_t vertex, float error, std::size_t& where) const {
    const glm::vec3 p = features_.RestOf(vertex);
    float best = error * error;
    bool found = false;
    for (std::size_t k = 0; k < after_.size(); ++k) {
      const Triangle& t = after_[k].second;
      const std::array numbers{vertices_[t[0]].number, vertices_[t[1]].number,
                               vertices_[t[2]].number};
      const glm::vec3 a = features_.RestOf(numbers[0]);
      const glm::vec3 b = features_.RestOf(numbers[1]) - a, c = features_.RestOf(numbers[2]) - a;
      const float bb = glm::dot(b, b), bc = glm::dot(b, c), cc = glm::dot(c, c);
      const float pb = glm::dot(p - a, b), pc = glm::dot(p - a, c);
      const float whole = std::max(bb * cc - bc * bc, 1e-12F);
      // A place beside the triangle counts as one on its edge near the nearest, so that the error
      // is not underestimated.
      glm::vec3 weights(0, (cc * pb - bc * pc) / whole, (bb * pc - bc * pb) / whole);
      weights.x = 1 - weights.y - weights.z;
      weights = glm::max(weights, 0.0F);
      weights /= weights.x + weights.y + weights.z;
      const float off = features_.Difference(vertex, numbers, weights, best);
      if (off > best) continue;
      best = off;
      where = k;
      found = true;
    }
    return found;
  }

  void Collapse(std::uint32_t v, std::uint32_t to) {
    for (const auto t : vertices_[v].triangles) {
      left_out_[t].clear();
      gone_[t] = Has(triangles_[t], to);
      if (!gone_[t]) continue;
      for (const auto corner : triangles_[t]) {
        if (corner != v) std::erase(vertices_[corner].triangles, t);
      }
    }
    for (const auto& [t, triangle] : after_) {
      triangles_[t] = triangle;
      vertices_[to].triangles.push_back(t);
    }
    for (const auto& [vertex, t] : moved_) left_out_[t].push_back(vertex);
    vertices_[v].triangles.clear();
  }

  const VertexFeatures& features_;
  bool open_;
  std::vector<Vertex> vertices_;
  std::vector<Triangle> triangles_;                   // of indices into vertices_
  std::vector<std::vector<std::uint32_t>> left_out_;  // numbers of vertices that lie on each
  std::vector<bool> gone_;                            // triangles
  // What Fits found for the collapse tried last: the triangles that get another corner, as they
  // would be, and for each vertex that is left out the triangle that takes it over.
  std::vector<std::pair<std::uint32_t, Triangle>> after_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> moved_;  // vertex, triangle
  std::uint32_t pass_ = 0;
};

}  // namespace

HeadTriangles CoarseTriangles(const Head& head, const CreaseWeights& creases, float error_mm) {
  const HeadTopology& topology = head.topology();
  const VertexFeatures features(head, creases);
  HeadTriangles coarse;
  for (HeadTopology::Part part : topology.parts) {
    PartDecimator shrinking(features, topology.Corners(part), IsHair(part.material));
    // The vertices that are missed least go first.
    for (const float share : {0.25F, 0.5F, 1.0F}) shrinking.Shrink(share * error_mm);
    part.first_index = static_cast<std::uint32_t>(coarse.indices.size());
    shrinking.Append(coarse.indices);
    part.index_count = static_cast<std::uint32_t>(coarse.indices.size()) - part.first_index;
    coarse.parts.push_back(part);
  }
  return coarse;
}

}  // namespace fsm
