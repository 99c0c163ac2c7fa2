#include "face_track/learn/judge.h"

#include <fmt/format.h>

#include <cmath>

#include "face_track/fit/image_fit.h"
#include "face_track/fit/person.h"

namespace facetrack {
namespace {

using What = FrameFit::What;

constexpr fsm::Angles kTurns[] = {{0, -30, 0}, {0, -20, 0}, {0, -10, 0},  {0, 10, 0}, {0, 20, 0},
                                  {0, 30, 0},  {-20, 0, 0}, {-10, 0, 0},  {10, 0, 0}, {20, 0, 0},
                                  {0, 0, 15},  {8, 12, 5},  {-12, 20, -8}};
constexpr float kDose = 0.7F;

/// A sum of squares.
struct Misses {
  float squares = 0;
  int count = 0;
  void Add(const fsm::Angles& found, const fsm::Angles& truth) {
    for (std::size_t k = 0; k < 3; ++k) squares += std::pow(found[k] - truth[k], 2.0F);
    count += 3;
  }
  float rms() const { return std::sqrt(squares / static_cast<float>(count)); }
};

void JudgeTurns(const FrameFit& fit, const Person& met, Sitter& sitter,
                const Sitter::Sight& at_rest, const Doing& rest) {
  const FaceLook shown(at_rest.picture, CropOf(fit.lens(), rest.pose));
  ImageFit image_fit(fit.face(), fit.lens(), met.rest, {{shown, rest.pose}});
  const glm::mat3 still = glm::transpose(rest.pose.turn) * at_rest.pose.turn;
  Misses by_points, by_picture;
  for (const fsm::Angles& turn : kTurns) {
    fsm::FaceState state;
    state.asymmetry = 0;
    state.head_rotation = turn;
    const auto sight = sitter.Look(state);
    const fsm::Angles truth = fsm::HeadRotationOf(sight.pose.turn);
    const Doing doing = fit.Solve(met.rest, sight.places, fit.Guess(sight.places), What::kPose);
    const FaceLook look(sight.picture, CropOf(fit.lens(), doing.pose));
    const auto [pose, like] = image_fit.Solve(met.rest, look, doing);
    const fsm::Angles found = fsm::HeadRotationOf(pose.turn * still);
    fmt::print("  {:>3} {:>3} {:>3}: off {:+.2f} {:+.2f} {:+.2f}, like {:.2f}\n", turn[0], turn[1],
               turn[2], found[0] - truth[0], found[1] - truth[1], found[2] - truth[2], like);
    by_points.Add(fsm::HeadRotationOf(doing.pose.turn * still), truth);
    by_picture.Add(found, truth);
  }
  fmt::print("  angles off, rms: {:.2f} degrees; by the network's points alone {:.2f}\n",
             by_picture.rms(), by_points.rms());
}

void JudgeDoses(const FrameFit& fit, const Person& met, Sitter& sitter, const Doing& rest) {
  const auto& channels = fit.face().channels;
  float off = 0, wrong = 0;
  int judged = 0;
  fmt::print("  units at {}, and all others:", kDose);
  for (const Channel& channel : channels) {
    if (channel.kind != Channel::Kind::kUnit || channel.side == "L") continue;
    fsm::FaceState state = StateOf(channel, kDose);
    state.au[fsm::Side::kLeft][static_cast<std::size_t>(channel.unit)] = kDose;
    const auto sight = sitter.Look(state);
    const Doing doing = fit.Solve(met.rest, sight.places, rest, What::kDoses);
    float found = 0, others = 0;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (channels[c].kind != Channel::Kind::kUnit) continue;
      (channels[c].unit == channel.unit ? found : others) += doing.doses[c];
    }
    if (!channel.side.empty()) found *= 0.5F;
    fmt::print(" {}:{:.2f},{:.2f}", channel.unit, found, others);
    off += std::abs(found - kDose) / kDose;
    wrong += others;
    ++judged;
  }
  fmt::print("\n  doses off by {:.0f} %, other units sum up to {:.2f}\n",
             100 * off / static_cast<float>(judged), wrong / static_cast<float>(judged));
}

}  // namespace

void Judge(const SeenFace& face, Sitter& sitter) {
  const FrameFit fit(face, sitter.lens());
  const auto at_rest = sitter.Look({});
  const Person met = Meet(fit, {{.places = at_rest.places, .depth = at_rest.depth}});
  const Doing rest = fit.Solve(met.rest, at_rest.places, fit.Guess(at_rest.places), What::kPose);
  JudgeTurns(fit, met, sitter, at_rest, rest);
  JudgeDoses(fit, met, sitter, rest);
}

}  // namespace facetrack
