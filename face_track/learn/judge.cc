#include "face_track/learn/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <span>
#include <utility>

#include "face_track/fit/image_fit.h"
#include "face_track/fit/person.h"
#include "face_track/model/shown_units.h"

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

/// From where a person's points lie at rest, mm in the head's frame.
Points MovedBy(const FrameFit& fit, const Person& met, const Sitter::Sight& sight,
               const Doing& doing) {
  Points moved = fit.OnFace(met.rest, sight.places, doing);
  for (std::size_t i = 0; i < kPoints; ++i) moved[i] -= met.rest[i];
  return moved;
}

/// As the picture shows them, without the depth.
float Product(const Points& a, const Points& b) {
  float sum = 0;
  for (std::size_t i = 0; i < kPoints; ++i) sum += glm::dot(glm::vec2(a[i]), glm::vec2(b[i]));
  return sum;
}

/// How far the points go, all together, as a head turns so little that nothing should be seen.
float Tremble(const FrameFit& fit, const Person& met, Sitter& sitter) {
  constexpr fsm::Angles kLittle[] = {{0, -2, 0}, {0, 2, 0}, {-2, 0, 0}, {2, 0, 0}, {0, 0, 2}};
  float squares = 0;
  for (const fsm::Angles& turn : kLittle) {
    fsm::FaceState state;
    state.head_rotation = turn;
    const auto sight = sitter.Look(state);
    const Doing doing = fit.Solve(met.rest, sight.places, fit.Guess(sight.places), What::kPose);
    const Points moved = MovedBy(fit, met, sight, doing);
    squares += Product(moved, moved);
  }
  return std::sqrt(squares / static_cast<float>(std::size(kLittle)));
}

/// The face with these units of both sides at a dose.
fsm::FaceState Together(std::span<const int> units, float dose = kDose) {
  fsm::FaceState state;
  state.asymmetry = 0;
  for (const fsm::Side side : fsm::kSides) {
    for (const int unit : units) state.au[side][static_cast<std::size_t>(unit)] = dose;
  }
  return state;
}

/// The doses of these units, the mean of both sides, and the sum of all others.
std::pair<std::vector<float>, float> Found(const SeenFace& face, std::span<const int> units,
                                           const Doing& doing) {
  std::vector<float> found(units.size(), 0.0F);
  float others = 0;
  for (std::size_t c = 0; c < face.channels.size(); ++c) {
    const Channel& channel = face.channels[c];
    if (channel.kind != Channel::Kind::kUnit) continue;
    const auto at = std::ranges::find(units, channel.unit);
    if (at == units.end())
      others += doing.doses[c];
    else
      found[static_cast<std::size_t>(at - units.begin())] +=
          channel.side.empty() ? doing.doses[c] : 0.5F * doing.doses[c];
  }
  return {found, others};
}

float Off(float found) { return std::abs(found - kDose) / kDose; }

std::vector<JudgedDose> JudgeDoses(const FrameFit& fit, const Person& met, Sitter& sitter,
                                   const Doing& rest) {
  const auto& channels = fit.face().channels;
  const float tremble = Tremble(fit, met, sitter);
  std::vector<JudgedDose> judged;
  for (const Channel& channel : channels) {
    if (channel.kind != Channel::Kind::kUnit || channel.side == "L") continue;
    const int unit = channel.unit;
    const auto sight = sitter.Look(Together({&unit, 1}));
    const Doing doing = fit.Solve(met.rest, sight.places, rest, What::kDoses);
    const auto [found, others] = Found(fit.face(), {&unit, 1}, doing);
    JudgedDose dose{.unit = unit, .found = found[0], .others = others};
    std::vector<float> told(channels.size(), 0.0F);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (channels[c].kind == Channel::Kind::kUnit && channels[c].unit == unit) told[c] = kDose;
    }
    const Points moved = MovedBy(fit, met, sight, rest);
    Points usual = Moved(fit.face(), met.rest, told);
    for (std::size_t i = 0; i < kPoints; ++i) usual[i] -= met.rest[i];
    dose.moved = std::sqrt(Product(moved, moved)) / tremble;
    dose.gain = Product(moved, usual) / Product(usual, usual);
    judged.push_back(dose);
  }
  return judged;
}

/// Several units at once, as expressions have them (prototypes of EMFACS and what people do as they
/// talk).
void JudgeExpressions(const FrameFit& fit, const Person& met, Sitter& sitter, const Doing& rest) {
  static const std::vector<int> kExpressions[] = {
      {6, 12},    {6, 12, 25},    {1, 2, 5, 26}, {4, 7, 23}, {4, 5, 7, 24}, {9, 10, 17},
      {1, 4, 15}, {1, 4, 15, 17}, {1, 2, 25},    {12, 26},   {20, 25},      {10, 12, 26}};
  float off = 0, others = 0;
  std::size_t count = 0;
  for (const auto& units : kExpressions) {
    const auto sight = sitter.Look(Together(units));
    const Doing doing = fit.Solve(met.rest, sight.places, rest, What::kDoses);
    const auto [found, rest_of] = Found(fit.face(), units, doing);
    std::string told;
    for (std::size_t k = 0; k < units.size(); ++k) {
      off += Off(found[k]);
      told += fmt::format(" {} {:.2f}", units[k], found[k]);
    }
    fmt::print("  together:{}; others {:.2f}\n", told, rest_of);
    count += units.size();
    others += rest_of / static_cast<float>(std::size(kExpressions));
  }
  fmt::print("  of several units at once doses off by {:.0f} %, others sum up to {:.2f}\n",
             100 * off / static_cast<float>(count), others);
}

/// What the points do as the head shows each unit.
std::vector<ShownUnit> Shown(const FrameFit& fit, const Person& met, Sitter& sitter,
                             const Doing& rest) {
  std::vector<ShownUnit> shown;
  for (const Channel& channel : fit.face().channels) {
    if (channel.kind != Channel::Kind::kUnit || channel.side == "L") continue;
    ShownUnit& unit = shown.emplace_back(ShownUnit{.unit = channel.unit, .moved = {}});
    const auto sight = sitter.Look(Together({&unit.unit, 1}, unit.dose));
    const Doing doing = fit.Solve(met.rest, sight.places, rest, What::kDoses);
    for (const glm::vec3& p : MovedBy(fit, met, sight, doing)) unit.moved.emplace_back(p);
  }
  return shown;
}

/// Mean and deviation of a number of some doses.
struct Average {
  float mean = 0, deviation = 0;
  Average(std::span<const JudgedDose> doses, float JudgedDose::*number) {
    const auto count = static_cast<float>(doses.size());
    for (const JudgedDose& d : doses) mean += d.*number / count;
    for (const JudgedDose& d : doses) deviation += std::pow(d.*number - mean, 2.0F) / count;
    deviation = std::sqrt(deviation);
  }
};

}  // namespace

std::vector<JudgedDose> Judge(const SeenFace& usual, Sitter& sitter, bool shown) {
  const FrameFit usual_fit(usual, sitter.lens());
  const auto at_rest = sitter.Look({});
  const Person met = Meet(usual_fit, {{.places = at_rest.places, .depth = at_rest.depth}});
  const Doing rest =
      usual_fit.Solve(met.rest, at_rest.places, usual_fit.Guess(at_rest.places), What::kPose);
  JudgeTurns(usual_fit, met, sitter, at_rest, rest);
  const SeenFace face = shown ? FaceOfPerson(usual, Shown(usual_fit, met, sitter, rest)) : usual;
  const FrameFit fit(face, sitter.lens());
  const auto judged = JudgeDoses(fit, met, sitter, rest);
  float off = 0;
  for (const JudgedDose& dose : judged) off += Off(dose.found) / static_cast<float>(judged.size());
  fmt::print("  doses off by {:.0f} %, other units sum up to {:.2f}\n", 100 * off,
             Average(judged, &JudgedDose::others).mean);
  JudgeExpressions(fit, met, sitter, rest);
  return judged;
}

std::string TableOfUnits(const std::vector<JudgedDose>& judged) {
  std::map<int, std::vector<JudgedDose>> by_unit;
  for (const JudgedDose& dose : judged) by_unit[dose.unit].push_back(dose);
  struct Row {
    float moved;
    std::string text;
  };
  std::vector<Row> rows;
  for (const auto& [unit, doses] : by_unit) {
    float squares = 0;
    for (const JudgedDose& dose : doses) squares += std::pow(Off(dose.found), 2.0F);
    const Average found(doses, &JudgedDose::found), gain(doses, &JudgedDose::gain);
    const float moved = Average(doses, &JudgedDose::moved).mean;
    rows.push_back(
        {moved, fmt::format("{:>4} {:>7.1f} {:>6.2f} {:>5.2f} {:>7.2f} {:>5.0f} {:>7.2f}\n", unit,
                            moved, gain.mean, gain.deviation, found.mean,
                            100 * std::sqrt(squares / static_cast<float>(doses.size())),
                            Average(doses, &JudgedDose::others).mean)});
  }
  std::ranges::sort(rows, std::greater{}, &Row::moved);
  std::string text = fmt::format(
      "units at {}; moved: in parts of what points do by themselves; gain: beside the table's\n"
      "unit   moved   gain   +-   found  rms %  others\n",
      kDose);
  for (const Row& row : rows) text += row.text;
  return text;
}

}  // namespace facetrack
