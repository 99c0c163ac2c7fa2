#include "face_track/learn/judge.h"

#include <fmt/format.h>

#include <cmath>

#include "face_track/fit/person.h"

namespace facetrack {
namespace {

struct Turn {
  float down, right, tilt;
};
constexpr Turn kTurns[] = {{0, -30, 0}, {0, -20, 0}, {0, -10, 0}, {0, 10, 0}, {0, 20, 0},
                           {0, 30, 0},  {-20, 0, 0}, {-10, 0, 0}, {10, 0, 0}, {20, 0, 0},
                           {0, 0, 15},  {8, 12, 5},  {-12, 20, -8}};

}  // namespace

void Judge(const SeenFace& face, Sitter& sitter) {
  const FrameFit fit(face, sitter.lens());
  const auto at_rest = sitter.Look({});
  const Person met = Meet(fit, {{.places = at_rest.places, .depth = at_rest.depth}});
  const Person own{.rest = sitter.rest(), .miss = 0};
  float squares[4] = {};
  for (const Turn& turn : kTurns) {
    fsm::FaceState state;
    state.asymmetry = 0;
    state.head_rotation = {turn.down, turn.right, turn.tilt};
    const auto sight = sitter.Look(state);
    const fsm::Angles truth = AnglesOf(sight.pose.turn);
    fmt::print("  {:>3} {:>3} {:>3}:", turn.down, turn.right, turn.tilt);
    int way = 0;
    for (const Person* person : {&own, &met}) {
      for (const bool units : {false, true}) {
        const Doing doing =
            fit.Solve(person->rest, sight.places, fit.Guess(sight.places), units);
        const fsm::Angles angles = AnglesOf(doing.pose.turn);
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

}  // namespace facetrack
