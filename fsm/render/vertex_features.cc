#include "fsm/render/vertex_features.h"

#include <glm/exponential.hpp>
#include <initializer_list>
#include <utility>

namespace fsm {
namespace {

// Weights that convert a difference between two vertices to millimetres of error.
constexpr float kNormalMm = 3;      // per radian
constexpr float kColourMm = 3;      // per factor of e in brightness, as eyes compare
constexpr float kOpenMm = 4;        // from occluded to open, from transparent to opaque
constexpr float kUnrolledMm = 150;  // across the skin's texture, which is about 310 mm wide
constexpr float kCreaseMm = 2;      // from no crease to a full one
constexpr float kStrandMm = 2;      // from no to dense hair; from a lock's middle to its side
constexpr float kTileMm = 0.5f;     // per millimetre along or across the hairs
constexpr float kPhotoMm = 0.5f;    // per millimetre in the photo
constexpr float kPhotoWidth = 300;  // assumed width of a photo, millimetres
/// A vertex that a blink moves this far (mm) is on a lid; its error is multiplied by the second
/// number.
constexpr float kLidMoves = 1, kLidCare = 3;

/// Returns states that move the face far, each in another way.
std::vector<FaceState> FarStates() {
  std::vector<FaceState> states(1);  // at rest
  const auto add = [&states](std::initializer_list<std::size_t> units, float jaw, float blink) {
    FaceState state;
    for (const std::size_t unit : units) state.au.left[unit] = state.au.right[unit] = 1;
    state.mouth[kJawY] = jaw;
    state.blink.left = state.blink.right = blink;
    states.push_back(state);
  };
  add({1, 2, 5, 25}, 20, 0);  // surprise
  add({6, 12, 25}, 6, 0.5f);  // a laugh
  add({4, 9, 10, 17}, 0, 1);  // disgust, eyes shut
  add({18, 22}, 4, 0);        // lips forward
  add({15, 20, 24}, 0, 0);    // lips stretched and pressed
  return states;
}

}  // namespace

VertexFeatures::VertexFeatures(const Head& head, const CreaseWeights& creases) {
  const HeadSurface& surface = head.surface();
  // Lids lie close to the eyeballs, which must not show through them.
  FaceState shut;
  shut.blink.left = shut.blink.right = 1;
  HeadVertices asleep;
  head.Evaluate(shut, asleep);
  for (std::size_t i = 0; i < asleep.position.size(); ++i) {
    const bool lid = glm::distance(asleep.position[i], head.rig().data().rest[i]) > kLidMoves;
    importance_.push_back(lid ? kLidCare : 1);
  }
  std::vector<std::vector<glm::vec3>> columns;
  for (const FaceState& state : FarStates()) {
    HeadVertices vertices;
    head.Evaluate(state, vertices);
    columns.push_back(std::move(vertices.position));
    for (glm::vec3& normal : vertices.normal) normal *= kNormalMm;
    columns.push_back(std::move(vertices.normal));
  }
  const std::size_t vertices = columns.front().size();
  const auto add = [&](bool there, const auto& value) {
    if (!there) return;
    auto& column = columns.emplace_back(vertices);
    for (std::size_t i = 0; i < vertices; ++i) column[i] = value(i);
  };
  constexpr float kDarkest = 0.02f;  // darker colours count as equal
  add(true, [&](std::size_t i) { return kColourMm * glm::log(surface.albedo[i] + kDarkest); });
  add(true, [&](std::size_t i) {
    return kOpenMm * glm::vec3(surface.openness[i],
                               surface.opacity.empty() ? 1 : surface.opacity[i],
                               surface.portrait.relit.empty() ? 0 : surface.portrait.relit[i]);
  });
  add(surface.uv.size() == vertices,
      [&](std::size_t i) { return kUnrolledMm * glm::vec3(surface.uv[i], 0); });
  const TextureMaps& maps = surface.textures;
  if (maps.base_colour && maps.texcoord.size() == vertices) {
    const glm::vec3 worth(kPhotoMm * kPhotoWidth, kPhotoMm * kPhotoWidth, kOpenMm);
    add(true, [&](std::size_t i) { return worth * glm::vec3(maps.texcoord[i], maps.weight[i]); });
  }
  add(surface.strands.size() == vertices, [&](std::size_t i) {
    const Strand& strand = surface.strands[i];
    return glm::vec3(kTileMm * strand.tile_mm, kStrandMm * strand.across);
  });
  add(surface.strands.size() == vertices,
      [&](std::size_t i) { return glm::vec3(kStrandMm * surface.strands[i].density, 0, 0); });
  const bool creased = creases.face.size() == vertices;
  add(creased, [&](std::size_t i) { return kCreaseMm * glm::vec3(creases.face[i]); });
  add(creased, [&](std::size_t i) {
    return kCreaseMm * glm::vec3(creases.face[i].w, creases.more[i].x, creases.more[i].z);
  });
  add(creased, [&](std::size_t i) { return kCreaseMm * glm::vec3(creases.more[i].y, 0, 0); });
  count_ = columns.size();
  values_.resize(vertices * count_);
  for (std::size_t k = 0; k < count_; ++k) {
    for (std::size_t i = 0; i < vertices; ++i) values_[i * count_ + k] = columns[k][i];
  }
}

}  // namespace fsm
