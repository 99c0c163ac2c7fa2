#include "face_track/learn/judge.h"

#include <fmt/format.h>

#include <cmath>

#include "face_track/fit/image_fit.h"
#include "face_track/fit/person.h"

namespace facetrack {
namespace {

struct Turn {
  float down, right, tilt;
};
constexpr Turn kTurns[] = {{0, -30, 0}, {0, -20, 0}, {0, -10, 0}, {0, 10, 0}, {0, 20, 0},
                           {0, 30, 0},  {-20, 0, 0}, {-10, 0, 0}, {10, 0, 0}, {20, 0, 0},
                           {0, 0, 15},  {8, 12, 5},  {-12, 20, -8}};

constexpr float kDose = 0.7F;

/// How large the doses of single units are found on a head that looks straight ahead.
void JudgeDoses(const FrameFit& fit, const Person& met, Sitter& sitter, const Doing& at_rest) {
  double off = 0, wrong = 0;
  int judged = 0;
  for (const Channel& channel : fit.face().channels) {
    if (channel.kind != Channel::Kind::kUnit || channel.side == "L") continue;
    fsm::FaceState state = StateOf(channel, kDose);
    const bool pair = channel.side == "R";
    if (pair) state.au[fsm::Side::kLeft][static_cast<std::size_t>(channel.unit)] = kDose;
    const auto sight = sitter.Look(state);
    const Doing doing = fit.Solve(met.rest, sight.places, at_rest, FrameFit::What::kDoses);
    const std::size_t own = fit.face().Find(channel.Name());
    float found = doing.doses[own], others = 0;
    if (pair) found = 0.5F * (found + doing.doses[fit.face().Find(std::to_string(channel.unit) + "L")]);
    std::string which;
    for (std::size_t c = 0; c < doing.doses.size(); ++c) {
      const Channel& other = fit.face().channels[c];
      if (other.kind != Channel::Kind::kUnit || other.unit == channel.unit) continue;
      others += doing.doses[c];
      if (doing.doses[c] > 0.15F) which += " " + other.Name();
    }
    fmt::print(" {}:{:.2f}/{:.2f}({})", channel.unit, found, others, which);
    off += std::abs(found - kDose) / kDose;
    wrong += others;
    ++judged;
  }
  fmt::print("\n  doses: off by {:.2f} of theirs, other units {:.2f}\n", off / judged, wrong / judged);
}

}  // namespace

void Judge(const SeenFace& face, Sitter& sitter) {
  const FrameFit fit(face, sitter.lens());
  const auto at_rest = sitter.Look({});
  const Person met = Meet(fit, {{.places = at_rest.places, .depth = at_rest.depth}});
  const Person own{.rest = sitter.rest(), .miss = 0};
  float squares[4] = {};
  const auto template_of = [&](const Person& person) {
    const Doing doing = fit.Solve(person.rest, at_rest.places, fit.Guess(at_rest.places), FrameFit::What::kPose);
    const FaceLook look(at_rest.picture, CropOf(fit.lens(), doing.pose));
    return ImageFit(face, fit.lens(), person.rest, look, doing);
  };
  ImageFit by_own = template_of(own), by_met = template_of(met);
  const glm::mat3 still = glm::transpose(fit.Solve(met.rest, at_rest.places, fit.Guess(at_rest.places), FrameFit::What::kPose).pose.turn) * at_rest.pose.turn;
  JudgeDoses(fit, met, sitter, fit.Solve(met.rest, at_rest.places, fit.Guess(at_rest.places), FrameFit::What::kPose));
  for (int pass = 0; pass < 2; ++pass) {
  std::fill(squares, squares + 4, 0.0F);
  for (const Turn& turn : kTurns) {
    fsm::FaceState state;
    state.asymmetry = 0;
    state.head_rotation = {turn.down, turn.right, turn.tilt};
    const auto sight = sitter.Look(state);
    const fsm::Angles truth = AnglesOf(sight.pose.turn);
    fmt::print("  {:>3} {:>3} {:>3} ({:.2f} {:.2f} {:.2f}):", turn.down, turn.right, turn.tilt, truth[0], truth[1], truth[2]);
    int way = 0;
    for (const Person* person : {&own, &met}) {
      for (const bool units : {false, true}) {
        Doing doing = fit.Solve(person->rest, sight.places, fit.Guess(sight.places), FrameFit::What::kPose);
        if (units) {
          const FaceLook look(sight.picture, CropOf(fit.lens(), doing.pose));
          const auto [pose, like] =
              (person == &own ? by_own : by_met).Solve(person->rest, look, doing);
          if (like >= ImageFit::kAlike) doing.pose = pose;
        }
        const fsm::Angles angles = AnglesOf(doing.pose.turn * (person == &own ? glm::mat3(1) : still));
        for (std::size_t k = 0; k < 3; ++k) {
          fmt::print(" {:+.2f}", angles[k] - truth[k]);
          squares[way] += (angles[k] - truth[k]) * (angles[k] - truth[k]);
        }
        fmt::print(" ({:.1f})", doing.miss);
        ++way;
      }
    }
    fmt::print("\n");
  }
    fmt::print("  rms: own {:.2f}, with units {:.2f}; met {:.2f}, with units {:.2f}\n",
             std::sqrt(squares[0] / 39), std::sqrt(squares[1] / 39), std::sqrt(squares[2] / 39),
             std::sqrt(squares[3] / 39));
  }
}

}  // namespace facetrack
