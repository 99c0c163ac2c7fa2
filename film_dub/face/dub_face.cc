#include "film_dub/face/dub_face.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <glm/vec4.hpp>
#include <string>
#include <utility>

#include "fsm/head/make_head.h"
#include "fsm/rig/angles.h"

namespace filmdub {
namespace {

constexpr float kViewMm = 330;  // from above to below (camera_pose.h)
constexpr int kLeastSide = 384, kMostSide = 1536;

fsm::Scene OnNothing() {
  fsm::Scene scene;
  scene.background = fsm::Transparent{};
  return scene;
}

}  // namespace

vm::Result<std::unique_ptr<DubFace>> DubFace::Make(facefit::FaceNetworks& networks,
                                                   const fsm::Image& picture,
                                                   std::span<const glm::vec2> places) {
  try {
    auto base = facefit::ObservedHead::BuiltIn(networks, "galatea");
    if (!base) return std::unexpected(base.error());
    const auto front = facefit::PrepareFront(networks, *base, picture,
                                             facefit::FaceNear{places[facefit::point::kNoseTip]},
                                             facefit::PhotoExtent::kCloseUp);
    if (!front) return std::unexpected(front.error());
    if (!front->face || front->face->found.certainty < facefit::kCertainFace) {
      return vm::Fail(vm::Errc::kBadValue,
                      "the face cannot be told apart in the picture where it is seen best");
    }
    const auto made = facefit::MakeFace(*base, front->photo, *front->face);
    if (!made) return std::unexpected(made.error());
    const float film_pixels_per_mm =
        made->fit.head.pose.PixelsPerMm() / front->photo.closeup_per_given_pixel;
    const int side = std::clamp(static_cast<int>(std::lround(kViewMm * film_pixels_per_mm)),
                                kLeastSide, kMostSide);
    return std::unique_ptr<DubFace>(new DubFace(std::move(*base), *made, side));
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kUnavailable, error.what());
  }
}

DubFace::DubFace(facefit::ObservedHead base, const facefit::MadeFace& made, int side)
    : base_(std::move(base)),
      head_(fsm::MakeHead(made.baked.head)),
      held_(fsm::HeadRotationOf(made.fit.head.pose.Rotation())),
      side_(side),
      context_(fsm::RenderContext::MakeHeadless(side, side)),
      renderer_(fsm::Renderer::Make(*context_)),
      scene_(OnNothing()),
      view_(fsm::ViewOfPortrait({}, scene_.camera, side, side)) {}

void DubFace::Pose(const fsm::FaceState& state) {
  state_ = state;
  head_->Evaluate(state_, vertices_);
}

const fsm::Image& DubFace::Draw() {
  context_->MakeCurrent();
  renderer_->DrawVertices(*head_, vertices_, state_.figure, scene_);
  renderer_->Read(drawn_);
  return drawn_;
}

std::vector<glm::vec2> DubFace::Points() const {
  std::vector<glm::vec2> points;
  points.reserve(base_.mesh_points().size());
  const glm::mat4 to_clip = view_.world_to_clip * view_.figure_to_world;
  for (const facefit::MeshPoint& point : base_.mesh_points()) {
    const glm::vec4 clip = to_clip * glm::vec4(point.On(vertices_.position), 1);
    points.push_back(0.5F * static_cast<float>(side_) *
                     glm::vec2(1 + clip.x / clip.w, 1 - clip.y / clip.w));
  }
  return points;
}

}  // namespace filmdub
