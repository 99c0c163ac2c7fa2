#include "fsm/motion/inputs/idle_kinds.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "fsm/motion/base/face_look.h"
#include "fsm/motion/inputs/pattern_fields.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kSlowly = 400ms, kQuickly = 60ms, kAtOnce = 0ms;

constexpr std::array kMoveFields = {
    PatternField{"DOWN", &AutoMove::down}, PatternField{"RIGHT", &AutoMove::right},
    PatternField{"TILT", &AutoMove::tilt}, PatternField{"PERIOD", &AutoMove::period_ms, 100}};
constexpr std::array kGazeFields = {PatternField{"ANGLE", &AutoGaze::angle},
                                    PatternField{"INTERVAL", &AutoGaze::interval_ms, 200}};
constexpr std::array kBreathFields = {PatternField{"PITCH", &AutoBreath::pitch},
                                      PatternField{"PERIOD", &AutoBreath::period_ms, 500}};
constexpr std::array kNodsFields = {PatternField{"ANGLE", &AutoNods::angle},
                                    PatternField{"INTERVAL", &AutoNods::interval_ms, 2000}};
constexpr std::array kSpeechFields = {
    PatternField{"NOD", &AutoSpeech::nod}, PatternField{"TURN", &AutoSpeech::turn},
    PatternField{"TILT", &AutoSpeech::tilt}, PatternField{"BROW", &AutoSpeech::brow}};
constexpr std::array kAvertFields = {PatternField{"ANGLE", &AutoAvert::angle},
                                     PatternField{"SHORTEST", &AutoAvert::shortest_ms}};
constexpr std::array kTextFields = {PatternField{"SIZE", &AutoText::size}};

template <auto kPatterns>
std::size_t SizeOf(const MotionPatterns& all) {
  return (all.*kPatterns).size();
}
std::size_t OnOff(const MotionPatterns&) { return 1; }
std::size_t SizeOfMoves(const MotionPatterns& all) {
  return all.auto_move_files.empty() ? all.auto_moves.size() : all.auto_move_files.size();
}

template <auto kPatterns, const auto& kFields>
void ReadFields(const TableRow& row, const UnitNames&, MotionPatterns& all) {
  ReadPatternFields(row, all.*kPatterns, kFields);
}

void ReadBlink(const TableRow& row, const UnitNames&, MotionPatterns& all) {
  CheckNextPattern(row, all.auto_blinks.size());
  if (row.size() != 4) row.Refuse("AUTOBLINK PATTERN INTERVAL BLINK expected");
  const double interval_ms = row.Within<double>(2, 500, 3'600'000, "INTERVAL");
  const double blink =
      row.Within<double>(3, 1, static_cast<double>(all.blinks.size()), "a BLINK above");
  all.auto_blinks.push_back({interval_ms, static_cast<std::size_t>(blink) - 1, true});
}

void ReadFace(const TableRow& row, const UnitNames& units, MotionPatterns& all) {
  CheckNextPattern(row, all.auto_faces.size());
  all.auto_faces.push_back(ReadLook(row, 2, units));
}

using All = MotionPatterns;
constexpr IdleKindRow kRows[] = {
    {IdleKind::kBlink, "BLINK", "", SizeOf<&All::auto_blinks>, ReadBlink, kQuickly},
    {IdleKind::kMove, "MOVE", ", the head drifts", SizeOfMoves,
     ReadFields<&All::auto_moves, kMoveFields>, kSlowly, true},
    {IdleKind::kUserdef, "USERDEF", ", files", SizeOf<&All::auto_userdef>, nullptr, kSlowly, true},
    {IdleKind::kGaze, "GAZE", ", small saccades", SizeOf<&All::auto_gazes>,
     ReadFields<&All::auto_gazes, kGazeFields>, kQuickly, true},
    {IdleKind::kBreath, "BREATH", "", SizeOf<&All::auto_breaths>,
     ReadFields<&All::auto_breaths, kBreathFields>, kSlowly, true},
    {IdleKind::kNods, "NODS", " of a listener", SizeOf<&All::auto_nods>,
     ReadFields<&All::auto_nods, kNodsFields>, kSlowly, true},
    {IdleKind::kSpeech, "SPEECH", ", head and brows move with the stress",
     SizeOf<&All::auto_speeches>, ReadFields<&All::auto_speeches, kSpeechFields>, kSlowly},
    {IdleKind::kAvert, "AVERT", ", the eyes leave the user while beginning to speak",
     SizeOf<&All::auto_averts>, ReadFields<&All::auto_averts, kAvertFields>, kSlowly},
    {IdleKind::kFace, "FACE", ", a slight look that stays", SizeOf<&All::auto_faces>, ReadFace,
     kSlowly},
    {IdleKind::kGazeBlink, "GAZEBLINK", ", blinks at shifts of the gaze", OnOff, nullptr, kAtOnce},
    {IdleKind::kEndBlink, "ENDBLINK", ", blinks at the end of speech", OnOff, nullptr, kAtOnce},
    {IdleKind::kAsymmetry, "ASYMMETRY", " of expressions", OnOff, nullptr, kAtOnce},
    {IdleKind::kText, "TEXT", ", looks of sentences by their words", SizeOf<&All::auto_texts>,
     ReadFields<&All::auto_texts, kTextFields>, kSlowly}};

constexpr bool InOrder() {
  for (std::size_t i = 0; i < std::size(kRows); ++i) {
    if (static_cast<std::size_t>(kRows[i].kind) != i) return false;
  }
  return std::size(kRows) == kIdleKindCount;
}
static_assert(InOrder());

}  // namespace

std::span<const IdleKindRow, kIdleKindCount> IdleKinds() { return kRows; }

const IdleKindRow& RowOf(IdleKind kind) { return kRows[static_cast<std::size_t>(kind)]; }

std::optional<IdleKind> IdleKindNamed(std::string_view name) {
  const auto found = std::ranges::find(kRows, name, &IdleKindRow::name);
  return found == std::end(kRows) ? std::nullopt : std::optional(found->kind);
}

}  // namespace fsm
