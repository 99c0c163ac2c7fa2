#include "fsm/render/coarse_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "fsm/render/vertex_features.h"

namespace fsm {
namespace {

/// A part of a head's mesh whose vertices are removed one by one: each is merged into a neighbour
/// (half-edge collapse, after Kobbelt, Campagna and Seidel 1998, "A general framework for mesh
/// decimation"), so the remaining vertices keep their positions.
class PartDecimator {
 public:
  /// `open`: vertices on the part's border may be removed, too, along the border.
  PartDecimator(const VertexFeatures& features, std::span<const std::uint32_t> corners, bool open)
      : features_(features), open_(open) {
    std::vector<std::uint32_t> own;  // 1 + index into vertices_, by the head's vertex
    for (std::size_t k = 0; k + 2 < corners.size(); k += 3) {
      Corners triangle{};
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t number = corners[k + c];
        if (number >= own.size()) own.resize(number + 1);
        if (own[number] == 0) {
          vertices_.push_back({number, features.RestOf(number)});
          own[number] = static_cast<std::uint32_t>(vertices_.size());
        }
        triangle[c] = own[number] - 1;
        vertices_[triangle[c]].triangles.push_back(static_cast<std::uint32_t>(triangles_.size()));
      }
      triangles_.push_back(Between(triangle));
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
        // A vertex that has lost a neighbour waits for the next pass, so that removal is even.
        if (vertex.changed_at > pass_) {
          any = true;
          continue;
        }
        vertex.tried_at = pass_;
        FindRing(v, ring_);
        if (!MayGo()) continue;
        // The shortest edges collapse first, which avoids slivers.
        for (Neighbour& n : ring_)
          n.far = glm::distance(vertex.position, vertices_[n.vertex].position);
        std::ranges::sort(ring_, {}, [](const Neighbour& n) { return std::pair(n.far, n.vertex); });
        const auto to =
            std::ranges::find_if(ring_, [&](const Neighbour& n) { return Fits(v, n, error); });
        if (to == ring_.end()) continue;
        Collapse(v, to->vertex);
        for (const Neighbour& n : ring_) vertices_[n.vertex].changed_at = pass_ + 1;
        any = true;
      }
    }
  }

  void Append(std::vector<std::uint32_t>& out) const {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (gone_[t]) continue;
      for (const auto corner : triangles_[t].corners) out.push_back(vertices_[corner].number);
    }
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;  // indices into vertices_
  struct Triangle {
    Corners corners;
    glm::vec3 normal;  // its length is twice the triangle's area
    float length;      // of `normal`
    bool Has(std::uint32_t v) const { return std::ranges::find(corners, v) != corners.end(); }
  };
  struct Vertex {
    std::uint32_t number;  // index in the head
    glm::vec3 position;
    std::vector<std::uint32_t> triangles{};  // the triangles around it
    std::uint32_t tried_at = 0;              // the last pass that could not remove it
    std::uint32_t changed_at = 0;            // the first pass after a neighbourhood change
  };
  struct Neighbour {
    std::uint32_t vertex;
    int triangles;  // triangles at the edge to it; one at a border
    float far = 0;
  };

  Triangle Between(const Corners& corners) const {
    const glm::vec3 a = vertices_[corners[0]].position;
    const glm::vec3 normal =
        glm::cross(vertices_[corners[1]].position - a, vertices_[corners[2]].position - a);
    return {corners, normal, glm::length(normal)};
  }

  void FindRing(std::uint32_t v, std::vector<Neighbour>& ring) const {
    ring.clear();
    for (const auto t : vertices_[v].triangles) {
      for (const auto corner : triangles_[t].corners) {
        if (corner == v) continue;
        const auto found = std::ranges::find(ring, corner, &Neighbour::vertex);
        if (found == ring.end()) {
          ring.push_back({corner, 1});
        } else {
          ++found->triangles;
        }
      }
    }
  }

  /// Tells whether the vertex in the middle of `ring_` may be removed. Both ends of an edge stay if
  /// more than two triangles meet there.
  bool MayGo() const {
    const auto ends = std::ranges::count(ring_, 1, &Neighbour::triangles);
    return (ends == 0 || (open_ && ends == 2)) &&
           std::ranges::none_of(ring_, [](const Neighbour& n) { return n.triangles > 2; });
  }

  /// Tells whether `v`, whose ring is `ring_`, may be merged into `to`; if so, `after_` holds the
  /// resulting triangles.
  bool Fits(std::uint32_t v, const Neighbour& to, float error) {
    const bool on_border = std::ranges::count(ring_, 1, &Neighbour::triangles) > 0;
    if (on_border && to.triangles != 1) return false;
    after_.clear();
    moved_.clear();
    for (const auto t : vertices_[v].triangles) {
      const Triangle& before = triangles_[t];
      if (before.Has(to.vertex)) continue;
      Corners corners = before.corners;
      std::ranges::replace(corners, v, to.vertex);
      const Triangle now = Between(corners);
      if (glm::dot(before.normal, now.normal) < 0.3f * before.length * now.length) return false;
      after_.emplace_back(t, now);
    }
    const auto settle = [&](std::uint32_t vertex) { return Settle(vertex, error); };
    if (!settle(vertices_[v].number)) return false;
    // With more common neighbours than triangles at the edge the surface would be pinched.
    FindRing(to.vertex, other_ring_);
    const auto common = std::ranges::count_if(other_ring_, [this](const Neighbour& n) {
      return std::ranges::find(ring_, n.vertex, &Neighbour::vertex) != ring_.end();
    });
    if (common != (on_border ? 1 : 2)) return false;
    return std::ranges::all_of(vertices_[v].triangles, [&](std::uint32_t t) {
      return std::ranges::all_of(left_out_[t], settle);
    });
  }

  /// Finds the triangle of `after_` that represents a vertex best and adds the pair to `moved_`;
  /// returns false if the error exceeds `error`.
  bool Settle(std::uint32_t vertex, float error) {
    const glm::vec3 p = features_.RestOf(vertex);
    float best = error * error;
    bool found = false;
    std::uint32_t where = 0;
    for (const auto& [triangle, after] : after_) {
      const Corners& t = after.corners;
      const std::array corners{&vertices_[t[0]], &vertices_[t[1]], &vertices_[t[2]]};
      const glm::vec3 a = corners[0]->position;
      const glm::vec3 b = corners[1]->position - a, c = corners[2]->position - a;
      const float bb = glm::dot(b, b), bc = glm::dot(b, c), cc = glm::dot(c, c);
      const float pb = glm::dot(p - a, b), pc = glm::dot(p - a, c);
      const float whole = std::max(bb * cc - bc * bc, 1e-12f);
      // A point beside the triangle is moved to its edge, near the closest point, so that the error
      // is not underestimated.
      glm::vec3 weights(0, (cc * pb - bc * pc) / whole, (bb * pc - bc * pb) / whole);
      weights.x = 1 - weights.y - weights.z;
      weights = glm::max(weights, 0.0f);
      weights /= weights.x + weights.y + weights.z;
      const float difference = features_.Difference(
          vertex, {corners[0]->number, corners[1]->number, corners[2]->number}, weights, best);
      if (difference > best) continue;
      best = difference;
      where = triangle;
      found = true;
    }
    if (found) moved_.emplace_back(vertex, where);
    return found;
  }

  void Collapse(std::uint32_t v, std::uint32_t to) {
    for (const auto t : vertices_[v].triangles) {
      left_out_[t].clear();
      gone_[t] = triangles_[t].Has(to);
      if (!gone_[t]) continue;
      for (const auto corner : triangles_[t].corners) {
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
  std::vector<Triangle> triangles_;
  std::vector<std::vector<std::uint32_t>> left_out_;  // vertices merged into each triangle
  std::vector<bool> gone_;                            // by triangle
  // The neighbours of the last vertex tried, and those of the other end of the last collapse tried.
  std::vector<Neighbour> ring_, other_ring_;
  // The result of Fits for the last collapse tried: the triangles that get another corner, in their
  // new form, and for each removed vertex the triangle that then represents it.
  std::vector<std::pair<std::uint32_t, Triangle>> after_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> moved_;  // vertex, triangle
  std::uint32_t pass_ = 0;
};

}  // namespace

HeadTriangles CoarseTriangles(const Head& head, const CreaseWeights& creases, float error_mm) {
  const HeadSurface& surface = head.surface();
  const VertexFeatures features(head, creases);
  HeadTriangles coarse;
  for (HeadSurface::Part part : surface.parts) {
    PartDecimator shrinking(features, surface.Corners(part), IsHair(part.material));
    // The least important vertices are removed first.
    for (const float share : {0.25f, 0.5f, 1.0f}) shrinking.Shrink(share * error_mm);
    part.first_index = static_cast<std::uint32_t>(coarse.indices.size());
    shrinking.Append(coarse.indices);
    part.index_count = static_cast<std::uint32_t>(coarse.indices.size()) - part.first_index;
    coarse.parts.push_back(part);
  }
  return coarse;
}

}  // namespace fsm
