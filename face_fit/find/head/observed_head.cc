#include "face_fit/find/head/observed_head.h"

#include <algorithm>
#include <glm/common.hpp>
#include <span>
#include <utility>

#include "face_fit/find/head/portrait_view.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/image/filters.h"
#include "face_fit/surface/rasterizer.h"
#include "face_fit/surface/visible_surface.h"
#include "fsm/head/make_head.h"
#include "fsm/mesh/rigging/transferred_rig.h"

namespace facefit {
namespace {

constexpr int kPortraitSize = 720;

/// Returns the points of the skin at some pixels of a portrait. `screen`: of its vertices, pixels
/// and the depth towards the viewer, millimetres; for pixels beside the skin the
/// nearest visible point that is no farther back than the ears. Returns nothing if no skin is
/// visible.
std::optional<PerPoint<MeshPoint>> SkinPointsAt(const VisibleSurface& skin,
                                                const std::vector<glm::vec3>& screen,
                                                const PerPoint<glm::vec3>& pixels) {
  constexpr float kFarthestBackMm = -20;
  if (std::ranges::max(skin.depth().values) < kFarthestBackMm) return std::nullopt;
  PerPoint<MeshPoint> found;
  const auto nearest = NearestAbove(skin.depth(), kFarthestBackMm);
  for (PointIndex k = 0; k < kNetworkPoints; ++k) {
    const glm::vec2 p(pixels[k]);
    const glm::ivec2 pixel = glm::clamp(glm::ivec2(p), 0, kPortraitSize - 1);
    const std::size_t own = skin.depth().Index(pixel.x, pixel.y), i = nearest[own];
    MeshPoint on_head =
        skin.SampleAt(static_cast<int>(i % kPortraitSize), static_cast<int>(i / kPortraitSize))
            ->OnMesh();
    // Refine the point within the pixel.
    const auto& t = on_head.corner;
    if (i == own) {
      on_head.weight = Triangle2{screen[t[0]], screen[t[1]], screen[t[2]]}.WeightsAt(p);
    }
    found[k] = on_head;
  }
  return found;
}

std::optional<LipSeam> LipSeamOf(const ObservedHead& base, const ObservedHead::Skin& skin) {
  const auto outer_lip = [&base](std::span<const PointIndex> points) {
    std::vector<glm::vec3> at_rest;
    for (const PointIndex i : points) at_rest.push_back(base.AtRest(i));
    return at_rest;
  };
  return FindLipSeam(base.surface(), base.rest().position, skin.triangles, skin.has_uv_seams,
                     outer_lip(point::kUpperOuterLip), outer_lip(point::kLowerOuterLip));
}

/// Moves the points of the inner lips, except the corners, up or down onto the lip seam.
void SnapToLipSeam(const std::vector<glm::vec3>& position, const LipSeam& seam,
                   PerPoint<MeshPoint>& points) {
  const float right = seam.EdgesAt(0).upper.On(position).x,
              left = seam.EdgesAt(1).upper.On(position).x;
  const auto edges = [&](PointIndex i) {
    return seam.EdgesAt(
        glm::clamp((points[i].On(position).x - right) / (left - right), 0.0F, 1.0F));
  };
  for (const PointIndex i : point::kUpperInnerLip) points[i] = edges(i).upper;
  for (const PointIndex i : point::kLowerInnerLip) points[i] = edges(i).lower;
}

}  // namespace

ObservedHead::ObservedHead(std::unique_ptr<fsm::Head> head, const std::string& name)
    : name_(name), head_(std::move(head)) {
  head_->Evaluate({}, rest_);
}

ObservedHead ObservedHead::Exact(std::unique_ptr<fsm::Head> head, const std::string& name,
                                 const PerPoint<MeshPoint>& points) {
  ObservedHead exact(std::move(head), name);
  exact.mesh_points_ = points;
  for (PointIndex i = 0; i < kNetworkPoints; ++i) exact.detected_depth_mm_[i] = exact.AtRest(i).z;
  return exact;
}

vm::Result<ObservedHead> ObservedHead::BuiltIn(FaceNetworks& networks, const std::string& name) {
  return FromBaseMesh(networks, fsm::MakeHead(name), name);
}

vm::Result<ObservedHead> ObservedHead::FromBaseMesh(FaceNetworks& networks,
                                                    std::unique_ptr<fsm::Head> head,
                                                    const std::string& name) {
  const Skin skin{.triangles = fsm::SkinTriangles(head->surface()), .has_uv_seams = false};
  auto base = Observe(networks, std::move(head), name, skin);
  if (base && base->lip_seam_)
    SnapToLipSeam(base->rest_.position, *base->lip_seam_, base->mesh_points_);
  return base;
}

vm::Result<ObservedHead> ObservedHead::Observe(FaceNetworks& networks,
                                               std::unique_ptr<fsm::Head> head,
                                               const std::string& name, const Skin& skin) {
  ObservedHead observed(std::move(head), name);
  const PortraitView view(kPortraitSize);
  NetworkPortrait portrait{view.Draw(observed.head(), observed.rest_, {}), {}};
  std::vector<glm::vec3> screen;
  for (const glm::vec3& p : observed.rest_.position) screen.emplace_back(view.PixelOf(p), p.z);
  const auto faces = FindFaces(networks, portrait.image);
  std::optional<PerPoint<MeshPoint>> found;
  if (!faces.empty()) {
    const SampleGrid pixels{glm::vec2(0.5F), 1, kPortraitSize, kPortraitSize};
    found =
        SkinPointsAt(DrawSkin(observed.surface(), screen, pixels), screen, faces.front().points);
  }
  if (!found) return vm::Fail(vm::Errc::kBadValue, "no face is seen on the head '" + name + "'");
  observed.mesh_points_ = *found;
  for (PointIndex i = 0; i < kNetworkPoints; ++i) {
    portrait.pixels[i] = faces.front().PixelOf(i);
    observed.detected_depth_mm_[i] = faces.front().points[i].z * view.mm_per_pixel();
  }
  observed.portrait_ = std::move(portrait);
  observed.lip_seam_ = LipSeamOf(observed, skin);
  return observed;
}

std::vector<glm::vec3> ObservedHead::InState(const fsm::FaceState& state) const {
  fsm::HeadVertices vertices;
  head_->Evaluate(state, vertices);
  return std::move(vertices.position);
}

void ObservedHead::UseUnits(const fsm::UnitTable& own) {
  units_ = own;
  head_ = head_->WithUnits(own);
}

}  // namespace facefit
