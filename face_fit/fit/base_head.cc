#include "face_fit/fit/base_head.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <stdexcept>
#include <utility>

#include "fsm/head/make_head.h"
#include "fsm/render/camera.h"
#include "fsm/render/renderer.h"

namespace facefit {
namespace {

constexpr int kSide = 720;

constexpr int kUpperOuter[] = {185, 40, 39, 37, 0, 267, 269, 270, 409};
constexpr int kLowerOuter[] = {146, 91, 181, 84, 17, 314, 405, 321, 375};
constexpr int kUpperInner[] = {78, 191, 80, 81, 82, 13, 312, 311, 310, 415, 308};
constexpr int kLowerInner[] = {95, 88, 178, 87, 14, 317, 402, 318, 324};
constexpr int kRightEye[] = {33,  246, 161, 160, 159, 158, 157, 173,
                             133, 155, 154, 153, 145, 144, 163, 7};
constexpr int kLeftEye[] = {263, 466, 388, 387, 386, 385, 384, 398,
                            362, 382, 381, 380, 374, 373, 390, 249};
constexpr int kFit[] = {
    // outline from the forehead round by the person's left
    10, 338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288, 397, 365, 379, 378, 400, 377, 152,
    148, 176, 149, 150, 136, 172, 58, 132, 93, 234, 127, 162, 21, 54, 103, 67, 109,
    // lips, outer and inner border
    61, 185, 40, 39, 37, 0, 267, 269, 270, 409, 291, 146, 91, 181, 84, 17, 314, 405, 321, 375, 78,
    191, 80, 81, 82, 13, 312, 311, 310, 415, 308, 95, 88, 178, 87, 14, 317, 402, 318, 324,
    // eyes
    33, 246, 161, 160, 159, 158, 157, 173, 133, 155, 154, 153, 145, 144, 163, 7, 263, 466, 388, 387,
    386, 385, 384, 398, 362, 382, 381, 380, 374, 373, 390, 249,
    // brows
    70, 63, 105, 66, 107, 46, 53, 52, 65, 55, 300, 293, 334, 296, 336, 276, 283, 282, 295, 285,
    // nose
    168, 6, 197, 195, 5, 4, 1, 2, 129, 358, 98, 327, 64, 294, 48, 278, 115, 344,
    // forehead, cheeks, chin
    151, 9, 8, 108, 337, 104, 333, 50, 280, 205, 425, 116, 345, 187, 411, 207, 427, 199, 18, 200,
    192, 416, 214, 434};

/// Of the inner lips, the point of the seam: both lips meet there at rest, so they are told apart
/// by how they move when the mouth opens.
void OntoSeam(const BaseHead& base, std::vector<MeshPlace>& places) {
  fsm::FaceState open;
  open.asymmetry = 0;
  open.au_left[27] = open.au_right[27] = 1;
  fsm::HeadVertices moved;
  base.head->Evaluate(open, moved);
  std::vector<std::uint32_t> lips;
  const auto& topology = base.head->topology();
  for (const auto& part : topology.parts) {
    if (part.material != fsm::Material::kLip) continue;
    lips.insert(lips.end(), topology.indices.begin() + part.first_index,
                topology.indices.begin() + part.first_index + part.index_count);
  }
  const auto snap = [&](int point, bool upper) {
    MeshPlace& place = places[static_cast<std::size_t>(point)];
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
  for (const int point : UpperInnerLip()) {
    if (point != 78 && point != 308) snap(point, true);
  }
  for (const int point : LowerInnerLip()) snap(point, false);
}

}  // namespace

std::span<const int> FitPoints() { return kFit; }
std::span<const int> UpperOuterLip() { return kUpperOuter; }
std::span<const int> LowerOuterLip() { return kLowerOuter; }
std::span<const int> UpperInnerLip() { return kUpperInner; }
std::span<const int> LowerInnerLip() { return kLowerInner; }
std::span<const int> EyeOutline(int side) {
  return side == 0 ? std::span<const int>(kRightEye) : std::span<const int>(kLeftEye);
}

void BaseHead::MoveBy(const fsm::UnitTable& own) {
  units = own;
  head = Moved(std::move(head));
}

std::unique_ptr<fsm::Head> BaseHead::Moved(std::unique_ptr<fsm::Head> other) const {
  auto moved = units ? other->WithUnits(*units) : nullptr;
  return moved ? std::move(moved) : std::move(other);
}

BaseHead BaseHead::See(FaceNetworks& networks, const std::string& name) {
  return See(networks, fsm::MakeHead(name), name, true);
}

BaseHead BaseHead::See(FaceNetworks& networks, std::unique_ptr<fsm::Head> head,
                       const std::string& name, bool own_seam) {
  BaseHead base;
  base.name = name;
  base.head = std::move(head);
  const fsm::FaceState state;
  base.head->Evaluate(state, base.rest);
  const auto context = fsm::RenderContext::MakeHeadless(kSide, kSide);
  fsm::Image picture;
  {
    const auto renderer = fsm::Renderer::Make(*context);
    renderer->Draw(*base.head, base.rest, state, fsm::Scene{});
    renderer->Read(picture);
  }
  const auto boxes = FindFaces(networks, picture);
  if (boxes.empty()) throw std::runtime_error("no face is seen on the head '" + name + "'");
  const FoundFace face = FindPoints(networks, picture, boxes.front());

  const fsm::View view = fsm::FramePortrait(state, fsm::Camera{}, kSide, kSide);
  std::vector<glm::vec3> screen;
  for (const glm::vec3& p : base.rest.position) {
    const glm::vec4 clip = view.world_to_clip * view.figure_to_world * glm::vec4(p, 1.0F);
    screen.emplace_back((clip.x / clip.w * 0.5F + 0.5F) * kSide,
                        (0.5F - clip.y / clip.w * 0.5F) * kSide, p.z);
  }
  const auto& topology = base.head->topology();
  base.places.resize(kNetworkPoints);
  for (std::size_t i = 0; i < kNetworkPoints; ++i) {
    const glm::vec2 at(face.points[i]);
    float best_z = -1e9F, nearest = 1e9F;
    MeshPlace aside;
    for (const auto& part : topology.parts) {
      if (part.material != fsm::Material::kSkin && part.material != fsm::Material::kLip) continue;
      for (std::uint32_t k = part.first_index; k < part.first_index + part.index_count; k += 3) {
        const std::uint32_t* t = &topology.indices[k];
        const glm::vec3 a = screen[t[0]], b = screen[t[1]], c = screen[t[2]];
        const float far = glm::distance(glm::vec2(a), at);
        if (far > 40 || a.z < -20) continue;
        const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        if (area > -1e-4F) continue;  // seen from behind: y runs down
        if (far < nearest) {
          nearest = far;
          aside = {{t[0], t[0], t[0]}, {1, 0, 0}};
        }
        const float u = ((at.x - a.x) * (c.y - a.y) - (c.x - a.x) * (at.y - a.y)) / area;
        const float v = ((b.x - a.x) * (at.y - a.y) - (at.x - a.x) * (b.y - a.y)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const float z = a.z + u * (b.z - a.z) + v * (c.z - a.z);
        if (z <= best_z) continue;
        best_z = z;
        base.places[i] = {{t[0], t[1], t[2]}, {1 - u - v, u, v}};
      }
    }
    if (best_z < -1e8F) base.places[i] = aside;
  }
  const float mm = 2 / view.samples_per_mm;  // samples lie twice as close as pixels
  for (const glm::vec3& p : face.points) {
    base.seen_z.push_back(p.z * mm);
    base.seen.emplace_back(p);
  }
  base.picture = std::move(picture);
  if (own_seam) OntoSeam(base, base.places);
  return base;
}

}  // namespace facefit
