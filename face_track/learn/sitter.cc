#include "face_track/learn/sitter.h"

#include <random>
#include <stdexcept>

#include "fsm/head/identity.h"
#include "fsm/head/make_head.h"
#include "fsm/mesh/head_points.h"
#include "vm_protocol/core/or_throw.h"

namespace facetrack {

using facefit::ObservedHead;

std::unique_ptr<fsm::Head> SomeHead(std::size_t number) {
  constexpr const char* kBases[] = {"galatea", "pygmalion"};
  if (number < 2) return fsm::MakeSymmetricHead(kBases[number]);
  std::mt19937 chance(static_cast<unsigned>(number));
  const auto between = [&chance](float low, float high) {
    return low + (high - low) * static_cast<float>(chance() % 10001) / 10000;
  };
  fsm::Identity identity = fsm::BuiltInIdentity(kBases[number % 2]);
  for (const std::string& name : fsm::SliderNames()) {
    identity.sliders.emplace_back(name, between(-1.2F, 1.2F));
  }
  identity.palette.skin *= between(0.35F, 1.1F);
  return fsm::MakeSymmetricHead(std::move(identity));
}

Sitter::Sitter(std::unique_ptr<fsm::Head> head, facefit::FaceNetworks& networks,
               facefit::AttentionNetwork& attention, HeadPainter& painter)
    : attention_(attention),
      painter_(painter),
      base_(vm::OrThrow(ObservedHead::FromBaseMesh(networks, std::move(head), "head"))) {
  scale_ = 1;
  for (int round = 0; round < 3; ++round) {
    const Sight sight = Look({});
    rest_.clear();
    for (std::size_t i = 0; i < kPoints; ++i) {
      rest_.push_back(sight.pose.Inverse(painter_.lens().Unproject(
          sight.places[i], scale_ * DepthOf(i, base_.rest()) + sight.pose.place.z)));
    }
    scale_ *= SeenFace::kEyesApart / glm::distance(rest_[33], rest_[263]);
    depth_ = sight.depth;
  }
}

Sitter::Sight Sitter::Look(const fsm::FaceState& state) {
  Sight sight;
  base_.head().Evaluate(state, sight.vertices);
  std::vector<fsm::PointPair> pairs;
  if (state.head_rotation != fsm::Angles{}) {
    for (const facefit::PointIndex i : facefit::point::kRigid) {
      pairs.push_back({base_.mesh_points()[i].On(sight.vertices.position), base_.AtRest(i)});
    }
  }
  const fsm::Similarity moved = pairs.empty() ? fsm::Similarity{} : fsm::FitSimilarity(pairs);
  const Pose rest = painter_.rest();
  sight.pose = {.turn = rest.turn * moved.rotation, .place = scale_ * (rest(moved.translation))};
  const facefit::NetworkCrop crop = CropOf(painter_.lens(), sight.pose);
  sight.picture = painter_.Draw(base_.head(), state);
  const auto found = attention_.Find(sight.picture, crop);
  if (found.face.certainty < facefit::kCertainFace) throw std::runtime_error("a face is lost");
  sight.places = PlacesOf(found);
  for (const glm::vec3& p : found.face.points) sight.depth.push_back(p.z * 245 / crop.size);
  return sight;
}

std::vector<glm::vec2> Sitter::Slides(float down, float right) {
  fsm::FaceState state;
  state.asymmetry = 0;
  state.head_rotation = {down, right, 0};
  const Sight sight = Look(state);
  std::vector<glm::vec2> slides;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const glm::vec3 q = sight.pose(rest_[i]);
    slides.push_back(glm::vec2(painter_.lens().Unproject(sight.places[i], q.z) - q));
  }
  return slides;
}

Sitter::Motion Sitter::MotionOf(const Channel& channel, float dose) {
  const Sight sight = Look(StateOf(channel, dose));
  Motion motion;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const float still = sight.pose(rest_[i]).z;
    const float z = still + scale_ * (DepthOf(i, sight.vertices) - DepthOf(i, base_.rest()));
    const auto moved_at = [&](float depth) {
      return sight.pose.Inverse(painter_.lens().Unproject(sight.places[i], depth)) - rest_[i];
    };
    motion.moved.push_back(moved_at(z));
    motion.seen.emplace_back(moved_at(still));
  }
  return motion;
}

float Sitter::DepthOf(std::size_t point, const fsm::HeadVertices& vertices) const {
  if (point < kIris) return base_.mesh_points()[point].On(vertices.position).z;
  const fsm::Side side = point == kIris ? fsm::Side::kRight : fsm::Side::kLeft;
  constexpr float kIrisBefore = 10;  // mm, of the middle of the eyeball
  return base_.head().EyeCentre(side).z + kIrisBefore;
}

fsm::FaceState StateOf(const Channel& channel, float dose) {
  fsm::FaceState state;
  state.asymmetry = 0;
  for (const fsm::Side side : fsm::kSides) {
    if (channel.side == (side == fsm::Side::kLeft ? "R" : "L")) continue;
    if (channel.kind == Channel::Kind::kUnit) {
      state.au[side][static_cast<std::size_t>(channel.unit)] = dose;
    } else {
      state.gaze[side][channel.kind == Channel::Kind::kGazeDown ? 0 : 1] = dose;
    }
  }
  return state;
}

}  // namespace facetrack
