#include "face_fit/fit/view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "face_fit/fit/form.h"
#include "face_fit/fit/pose_fit.h"
#include "face_fit/fit/stereo.h"
#include "fsm/render/camera.h"
#include "fsm/render/renderer.h"

namespace facefit {
namespace {

constexpr int kSide = 640;
/// Below it a photo tells no more of depth than the first one did; beyond it the network guesses.
constexpr float kLeastTurn = 12, kMostTurn = 80;  // degrees
/// Points of the same face drawn and seen lie nearer than that, those of another mostly do not.
constexpr float kMostResidual = 2.6F;  // millimetres

/// What can be compared: points of the network with the place of the worn head, and how far beside
/// it the network sees them (millimetres to the right and down, as the camera has it).
struct Mark {
  std::size_t point;
  glm::vec3 at;
  glm::vec2 bias{0};
  float weight = 1;
};

std::vector<Mark> MarksOf(const BaseHead& base, const Fit& fit) {
  std::vector<Mark> marks;
  for (const int i : FitPoints()) {
    const auto k = static_cast<std::size_t>(i);
    marks.push_back({k, base.places[k].On(fit.worn)});
  }
  return marks;
}

/// As marks of a pose: the bias belongs to what is seen.
std::vector<PoseMark> Shown(const std::vector<Mark>& marks, const FoundFace& face,
                            const Pose& pose) {
  std::vector<PoseMark> shown;
  for (const Mark& mark : marks) {
    const glm::vec2 seen(face.points[mark.point]);
    shown.push_back({mark.at, seen - mark.bias * pose.PixelsPerMm(), mark.weight});
  }
  return shown;
}

std::vector<glm::vec3> NormalsOf(const fsm::HeadTopology& topology,
                                 const std::vector<glm::vec3>& position) {
  std::vector<glm::vec3> normal(position.size(), glm::vec3(0));
  for (std::size_t i = 0; i + 2 < topology.indices.size(); i += 3) {
    const std::uint32_t* t = &topology.indices[i];
    const glm::vec3 n =
        glm::cross(position[t[1]] - position[t[0]], position[t[2]] - position[t[0]]);
    for (int c = 0; c < 3; ++c) normal[t[c]] += n;
  }
  for (glm::vec3& n : normal) n = glm::normalize(n + glm::vec3(0, 0, 1e-12F));
  return normal;
}

/// Draws the worn head turned as in the pose, lets the network look at it, and notes in the marks
/// how far beside their places it sees them, and which of them are turned away. False if it sees no
/// face.
bool NoteBias(FaceNetworks& networks, const BaseHead& base, const Fit& fit, const Pose& pose,
              std::vector<Mark>& marks) {
  fsm::HeadVertices turned;
  for (const glm::vec3& p : fit.worn) turned.position.push_back(pose.ToCamera(p));
  turned.normal = NormalsOf(base.head->topology(), turned.position);
  const auto context = fsm::RenderContext::MakeHeadless(kSide, kSide);
  fsm::Image picture;
  {
    const auto renderer = fsm::Renderer::Make(*context);
    renderer->Draw(*base.head, turned, {}, fsm::Scene{});
    renderer->Read(picture);
  }
  const auto boxes = FindFaces(networks, picture);
  if (boxes.empty()) return false;
  const FoundFace seen = FindPoints(networks, picture, boxes.front());
  const fsm::View view = fsm::FramePortrait({}, fsm::Camera{}, kSide, kSide);
  const float mm = 2 / view.samples_per_mm;  // samples lie twice as close as pixels
  for (Mark& mark : marks) {
    const auto& place = base.places[mark.point];
    const glm::vec4 clip =
        view.world_to_clip * view.figure_to_world * glm::vec4(place.On(turned.position), 1.0F);
    const glm::vec2 at((clip.x / clip.w * 0.5F + 0.5F) * kSide,
                       (0.5F - clip.y / clip.w * 0.5F) * kSide);
    mark.bias = (glm::vec2(seen.points[mark.point]) - at) * mm;
    const float facing = place.On(turned.normal).z;
    mark.weight = facing > 0.1F ? 1.0F : 0.15F;
  }
  return true;
}

}  // namespace

vm::Result<View> PlaceView(FaceNetworks& networks, const BaseHead& base, const Fit& fit,
                           const fsm::Image& photo) {
  const auto boxes = FindFaces(networks, photo);
  if (boxes.empty()) return vm::Fail(vm::Errc::kBadValue, "no face is found in it");
  View view;
  view.face = FindPoints(networks, photo, boxes.front());
  if (view.face.certainty < 0.5F) {
    return vm::Fail(vm::Errc::kBadValue,
                    "no eyes, nose and mouth can be told apart in it; turned by 20 to 60 degrees "
                    "they can");
  }
  std::vector<Mark> marks = MarksOf(base, fit);
  const glm::vec2 top(view.face.points[168]), chin(view.face.points[152]);
  const float tall = glm::distance(base.places[168].On(fit.worn), base.places[152].On(fit.worn));
  Pose start = fit.pose;
  start.focal = fit.pose.focal / fit.pose.PixelsPerMm() * glm::distance(top, chin) / tall;
  const glm::vec2 down = chin - top;
  start.turn.z = std::atan2(-down.x, -down.y) + (down.y > 0 ? glm::radians(180.0F) : 0);
  if (start.turn.z > glm::radians(180.0F)) start.turn.z -= glm::radians(360.0F);
  std::optional<Pose> best;
  for (const float turn : {-60.0F, -30.0F, 0.0F, 30.0F, 60.0F}) {
    Pose from = start;
    from.turn = {0, glm::radians(turn), start.turn.z};
    from.centre = {0, 0};
    from.centre =
        glm::vec2(view.face.points[6]) - from.Project(from.ToCamera(base.places[6].On(fit.worn)));
    const auto shown = Shown(marks, view.face, from);
    const Pose pose = SettlePose(shown, from);
    if (!best || MeanOff(pose, shown) < MeanOff(*best, shown)) best = pose;
  }
  view.pose = *best;
  const float turn = std::abs(glm::degrees(view.pose.turn.y - fit.pose.turn.y));
  if (turn < kLeastTurn) {
    return vm::Fail(vm::Errc::kBadValue,
                    "it shows the face from the front like the first; 20 to 60 degrees help");
  }
  if (turn > kMostTurn || !NoteBias(networks, base, fit, view.pose, marks)) {
    return vm::Fail(vm::Errc::kBadValue,
                    "the face is turned too far to be compared; 20 to 60 degrees can be");
  }
  const auto shown = Shown(marks, view.face, view.pose);
  view.pose = SettlePose(shown, view.pose);
  view.residual_mm = MeanOff(view.pose, shown);
  if (view.residual_mm > kMostResidual) {
    std::string mm = std::to_string(view.residual_mm);
    mm.resize(3);
    return vm::Fail(vm::Errc::kBadValue, "its face does not fit the first photo's (points lie " +
                                             mm + " mm apart); is it the same person?");
  }
  return view;
}

void Deepen(const BaseHead& base, const fsm::Image& front, const fsm::Image& side, View& view,
            Fit& fit) {
  for (int round = 0; round < 2; ++round) {
    const auto said = CompareDepth(base, fit, front, side, view);
    if (said.empty()) return;
    // What the far cheek hides is taken to be as the near one.
    std::vector<fsm::WarpPoint> both = said;
    const glm::vec3 towards = glm::transpose(view.pose.Rotation()) * glm::vec3(0, 0, 1);
    for (const fsm::WarpPoint& point : said) {
      if (point.at.x * towards.x > 0 && std::abs(point.at.x) > 12) {
        both.push_back({point.at * glm::vec3(-1, 1, 1), point.by});
      }
    }
    // Of single patches some are mistaken: those far from what their neighbours say are left out.
    constexpr float kSmooth = 60, kEven = 12, kFar = 2, kMost = 10;
    const fsm::Warp rough(both, kSmooth);
    std::erase_if(both, [&](const fsm::WarpPoint& point) {
      return std::abs(rough.Motion(point.at).z - point.by.z) > kFar;
    });
    if (both.size() < 20) return;
    const fsm::Warp depth(both, kEven);
    for (LandmarkConstraint& aim : fit.aims) {
      aim.z += std::clamp(depth.Motion(aim.place.On(base.rest.position)).z, -kMost, kMost);
    }
    WarpToLandmarks(base, fit);
  }
}

}  // namespace facefit
