#include "face_fit/find/head/base_head.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/find/head/portrait_view.h"
#include "face_fit/find/head/rasterizer.h"
#include "fsm/head/make_head.h"

namespace facefit {
namespace {

constexpr int kSide = 720;

/// Moves the points of the inner lips onto the seam. Both lips meet there at rest, so they are told
/// apart by how they move when the mouth opens.
void OntoSeam(const BaseHead& base, std::vector<MeshPoint>& points) {
  fsm::FaceState open;
  open.asymmetry = 0;
  open.au.left[27] = open.au.right[27] = 1;
  fsm::HeadVertices moved;
  base.head->Evaluate(open, moved);
  std::vector<std::uint32_t> lips;
  const auto& topology = base.head->topology();
  for (const auto& part : topology.parts) {
    if (part.material != fsm::Material::kLip) continue;
    lips.insert(lips.end(), topology.indices.begin() + part.first_index,
                topology.indices.begin() + part.first_index + part.index_count);
  }
  const auto snap = [&](PointIndex i, bool upper) {
    MeshPoint& place = points[i];
    const glm::vec3 at = place.On(base.rest.position);
    const auto near = [&](std::uint32_t v) {
      const glm::vec3 d = base.rest.position[v] - at;
      return std::abs(d.x) < 2.2F && std::abs(d.y) < 9 && d.z > -5;
    };
    const auto fall = [&](std::uint32_t v) {
      return moved.position[v].y - base.rest.position[v].y;
    };
    float least = 1e9F, most = -1e9F;
    for (const std::uint32_t v : lips) {
      if (!near(v)) continue;
      least = std::min(least, fall(v));
      most = std::max(most, fall(v));
    }
    const float middle = 0.5F * (least + most);
    float best = -1e9F;
    for (const std::uint32_t v : lips) {
      if (!near(v) || (fall(v) > middle) != upper) continue;
      const float height = base.rest.position[v].y;
      // The seam's own vertices lie at the front of the inside: prefer the foremost of the last.
      const float merit = (upper ? -height : height) + 0.3F * base.rest.position[v].z;
      if (merit > best) {
        best = merit;
        place = {{v, v, v}, {1, 0, 0}};
      }
    }
  };
  const auto upper = UpperInnerLip();
  for (const PointIndex i : upper.subspan(1, upper.size() - 2)) snap(i, true);
  for (const PointIndex i : LowerInnerLip()) snap(i, false);
}

/// The place of the skin that is seen foremost at a pixel; beside the skin its nearest vertex.
/// `screen`: of each vertex, pixels with y down, and depth towards the viewer in millimetres.
MeshPoint PlaceUnder(const fsm::HeadTopology& topology, const std::vector<glm::vec3>& screen,
                     glm::vec2 at) {
  constexpr float kNear = 40, kBack = -20;  // pixels; millimetres
  constexpr float kLeastArea = 1e-4F;       // pixels
  float foremost = -1e9F, nearest = 1e9F;
  MeshPoint place, beside;
  ForSkinTriangles(topology, [&](const std::uint32_t* t) {
    const float far = glm::distance(glm::vec2(screen[t[0]]), at);
    if (far > kNear || screen[t[0]].z < kBack) return;
    const Triangle2 triangle{screen[t[0]], screen[t[1]], screen[t[2]]};
    if (triangle.SignedArea() > -kLeastArea) return;  // seen from behind: y runs down
    if (far < nearest) {
      nearest = far;
      beside = {{t[0], t[0], t[0]}, {1, 0, 0}};
    }
    const glm::vec3 weights = triangle.WeightsAt(at);
    if (std::min({weights.x, weights.y, weights.z}) < 0) return;
    const float z = Interpolated(screen, t, weights).z;
    if (z <= foremost) return;
    foremost = z;
    place = {{t[0], t[1], t[2]}, weights};
  });
  return foremost < -1e8F ? beside : place;
}

}  // namespace

void BaseHead::MoveBy(const fsm::UnitTable& own) {
  units = own;
  head = head->WithUnits(own);
}

vm::Result<BaseHead> BaseHead::See(FaceNetworks& networks, const std::string& name) {
  return See(networks, fsm::MakeHead(name), name, true);
}

vm::Result<BaseHead> BaseHead::See(FaceNetworks& networks, std::unique_ptr<fsm::Head> head,
                                   const std::string& name, bool own_seam) {
  BaseHead base;
  base.name = name;
  base.head = std::move(head);
  const fsm::FaceState state;
  base.head->Evaluate(state, base.rest);
  const PortraitView portrait(kSide);
  fsm::Image picture = portrait.Draw(*base.head, base.rest, state);
  const auto faces = FindFaces(networks, picture);
  if (faces.empty()) {
    return vm::Fail(vm::Errc::kBadValue, "no face is seen on the head '" + name + "'");
  }
  const FoundFace& face = faces.front();

  std::vector<glm::vec3> screen;
  for (const glm::vec3& p : base.rest.position) screen.emplace_back(portrait.Pixel(p), p.z);
  for (const glm::vec3& p : face.points) {
    base.points.push_back(PlaceUnder(base.head->topology(), screen, glm::vec2(p)));
  }
  for (const glm::vec3& p : face.points) {
    base.seen_z.push_back(p.z * portrait.mm_per_pixel());
    base.seen.emplace_back(p);
  }
  base.picture = std::move(picture);
  if (own_seam) OntoSeam(base, base.points);
  return base;
}

}  // namespace facefit
