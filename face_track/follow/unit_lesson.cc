#include "face_track/follow/unit_lesson.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>

#include "face_track/fit/person.h"
#include "fsm/base/table_reader.h"

namespace facetrack {
namespace {

constexpr float kHardlyShown = 0.15F;    // of how far the points usually go
constexpr double kLongestLesson = 3600;  // seconds

/// How far points lie from their rest the usual way, in parts of it.
float PartOf(const std::vector<glm::vec2>& usual, const Points& points, const Points& rest) {
  float along = 0, squares = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    along += glm::dot(usual[i], glm::vec2(points[i] - rest[i]));
    squares += glm::dot(usual[i], usual[i]);
  }
  return along / squares;
}

}  // namespace

vm::Result<UnitLesson> UnitLesson::Parse(const std::string& name, std::string_view prompts,
                                         const SeenFace& face) {
  return fsm::ReadTable(name, prompts, [&](const fsm::Table& table) {
    std::vector<Prompt> read;
    for (const fsm::TableRow& row : table.rows()) {
      if (row.key() != "show") row.Refuse("expected 'show'");
      const double from = row.Within<double>(1, 0, kLongestLesson, "seconds");
      const double to = row.Within<double>(2, 0, kLongestLesson, "seconds");
      Prompt prompt{
          .from_ms = 1000 * from,
          .to_ms = 1000 * to,
          .unit = row.Integer(3),
          .dose = row.size() > 4 ? row.Within(4, ShownUnit::kLeastDose, ShownUnit::kMostDose) : 1,
          .place = {}};
      row.EndsAt(5);
      prompt.place = fmt::format("{}: unit {} from {:g} s to {:g} s", name, prompt.unit, from, to);
      if (!(prompt.from_ms > (read.empty() ? 0 : read.back().to_ms)))
        row.Refuse("expected times that rise, the first after the face has been at rest");
      if (!(to > from) || to - from > kMostMs / 1000)
        row.Refuse(fmt::format("expected an end up to {:g} s after the begin", kMostMs / 1000));
      if (std::ranges::any_of(read, [&](const Prompt& p) { return p.unit == prompt.unit; }))
        row.Refuse(fmt::format("unit {} comes twice", prompt.unit));
      const auto usual = UsualMotion(face, prompt.unit, prompt.dose);
      if (std::ranges::all_of(usual, [](glm::vec2 p) { return p == glm::vec2(0); }))
        row.Refuse(fmt::format("unit {} is none that is followed", prompt.unit));
      read.push_back(std::move(prompt));
    }
    if (read.empty() || read.size() > kMostPrompts)
      table.Refuse(fmt::format("1 to {} rows 'show' expected", kMostPrompts));
    return UnitLesson(face, std::move(read));
  });
}

void UnitLesson::Add(const FaceLine& line) {
  while (so_far_ && next_ < prompts_.size()) {
    // The rest lasts until the first prompt begins, what is shown until it ends.
    const Prompt& prompt = prompts_[next_];
    if (line.ms < (rest_.empty() ? prompt.from_ms : prompt.to_ms)) break;
    Close();
  }
  if (next_ == prompts_.size() || !so_far_ || line.person == 0) return;
  if (!rest_.empty() && line.ms < prompts_[next_].from_ms) return;
  if (person_ == 0) person_ = line.person;
  if (line.person != person_) {
    so_far_ =
        vm::Fail(vm::Errc::kBadValue, fmt::format("another face from {:.1f} s on", line.ms / 1000));
    return;
  }
  if (pictures_.size() < kMostPictures) pictures_.push_back(line.points);
}

void UnitLesson::Close() {
  std::vector<Points> pictures = std::exchange(pictures_, {});
  if (rest_.empty()) {
    if (pictures.empty())
      so_far_ = vm::Fail(vm::Errc::kBadValue, "no face is seen before the first unit is shown");
    else
      rest_ = MedianOf(pictures);
    return;
  }
  const Prompt& prompt = prompts_[next_++];
  const auto leave_out = [&](const std::string& why) {
    learned_.left_out.push_back(prompt.place + ": " + why + "; the unit is left as it usually is");
  };
  if (pictures.empty()) return leave_out("no face is seen");
  const auto usual = UsualMotion(*face_, prompt.unit, prompt.dose);
  std::ranges::sort(pictures, std::greater{},
                    [&](const Points& points) { return PartOf(usual, points, rest_); });
  pictures.resize((pictures.size() + 1) / 2);
  const Points most = MedianOf(pictures);
  const float part = PartOf(usual, most, rest_);
  if (part < kHardlyShown)
    return leave_out(fmt::format("the points go {:.0f} % of the usual way", 100 * part));
  ShownUnit& shown =
      learned_.shown.emplace_back(ShownUnit{.unit = prompt.unit, .dose = prompt.dose, .moved = {}});
  for (std::size_t i = 0; i < kPoints; ++i) shown.moved.emplace_back(most[i] - rest_[i]);
}

vm::Result<UnitLesson::Learned> UnitLesson::Finish() {
  while (so_far_ && next_ < prompts_.size()) Close();
  if (!so_far_) return std::unexpected(so_far_.error());
  return std::move(learned_);
}

}  // namespace facetrack
