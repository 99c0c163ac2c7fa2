#include "fsm/motion/expression/expression_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/base/motion_errors.h"
#include "fsm/motion/inputs/motion_inputs.h"

namespace fsm {
namespace {

constexpr vm::Time kOffset = std::chrono::milliseconds(500);  // natural offset duration
constexpr double kSideLagMs = 30, kSideLagVariesMs = 10;      // of the side that begins later

}  // namespace

ExpressionMotion::ExpressionMotion(const MotionInputs& in)
    : tables_(in.tables),
      expressions_(in.expressions.all()),
      settings_(in.settings),
      switches_(in.switches),
      seed_(in.seed),
      emotions_(in.tables.unit_list.face_slots.size()) {
  DrawLags(seed_);
}

void ExpressionMotion::DrawLags(std::uint64_t seed) {
  side_lags_ms_ = {};
  const Side late = RandomAt(seed, RandomStream::kLateSide, 0) < 0 ? Side::kLeft : Side::kRight;
  side_lags_ms_[late] = kSideLagMs + kSideLagVariesMs * RandomAt(seed, RandomStream::kLag, 0);
}

// ---- commands

vm::Time ExpressionMotion::OnsetOf(const Expression& expression) const {
  switch (settings_.onset) {
    case Onset::kPosed:
      return FromMs(expression.posed.onset_ms);
    case Onset::kElicited:
      return FromMs(expression.elicited.onset_ms);
    case Onset::kFixed:
      break;
  }
  return settings_.expression;
}

vm::Result<void> ExpressionMotion::Show(vm::Time now, std::string_view name, int pattern,
                                        double strength, vm::Time duration) {
  const auto found = expressions_.find(name);
  if (found == expressions_.end()) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("'{}' is no expression; {} or NEUTRAL expected", name, KeysOf(expressions_)));
  }
  const Expression& expression = found->second;
  if (auto fits = CheckPatternNumber(name, pattern, 1, expression.patterns.size()); !fits)
    return fits;
  if (auto fits = CheckStrength(strength); !fits) return fits;
  Plan(now, expression.LookOf(pattern, strength),
       settings_.onset == Onset::kElicited ? expression.elicited : expression.posed,
       OnsetOf(expression), duration);
  return {};
}

void ExpressionMotion::ShowSpacePoint(vm::Time now, const EmotionSpace::Point& point,
                                      std::optional<vm::Time> move) {
  // Lags belong to expressions of the table; a point between them has none.
  Expression::Timing timing;
  if (move) timing.lag_ms = {};
  const vm::Time onset = move.value_or(OnsetOf({}));
  Plan(now, tables_.emotion_space.LookOf(point), timing, onset, vm::Time(0));
  shown_.MoveTo(now, std::min(1.0f, std::hypot(point[0], point[1], point[2])), onset);
}

void ExpressionMotion::Plan(vm::Time now, const FaceLook& look, const Expression::Timing& timing,
                            vm::Time onset, vm::Time duration) {
  for (const Side side : kSides) {
    const double side_lag_ms = switches_[IdleKind::kAsymmetry].on() ? side_lags_ms_[side] : 0;
    for (std::size_t region = 0; region < kRegions; ++region) {
      const vm::Time lag = FromMs(timing.lag_ms[region] + side_lag_ms);
      regions_[side][region].Visit(now, look, onset, duration, lag);
    }
  }
  onset_end_ = now + shown_.Visit(now, 1.0f, onset, duration);
  end_ = duration > vm::Time(0) ? std::optional(now + duration) : std::nullopt;
}

void ExpressionMotion::Neutral(vm::Time now) {
  const vm::Time offset = settings_.onset == Onset::kFixed ? settings_.expression : kOffset;
  for (const Side side : kSides) {
    for (auto& region : regions_[side]) region.Plan(now, FaceLook{}, now, offset);
  }
  shown_.MoveTo(now, 0.0f, offset);
  onset_end_ = now + offset;
  end_.reset();
}

void ExpressionMotion::SetEmotion(vm::Time now, std::size_t index, double strength) {
  const Expression& emotion =
      expressions_.find(tables_.unit_list.face_slots[index].emotion)->second;
  emotions_[index].MoveTo(now, static_cast<float>(strength), OnsetOf(emotion));
}

// ---- as a source

void ExpressionMotion::Contribute(vm::Time t, MotionLayers& layers) const {
  Sided<std::array<FaceLook, kRegions>> now;
  layers.AddSignal(SignalName::kExpression, shown_.At(t));
  FaceLook& out = layers.Layer(LayerName::kExpression).look;
  for (const Side side : kSides) {
    std::size_t size = 0;
    for (std::size_t region = 0; region < kRegions; ++region) {
      now[side][region] = regions_[side][region].At(t);
      size = std::max(size, now[side][region].au[side].size());
    }
    for (std::size_t unit = size; unit-- > 0;) {
      const auto of = static_cast<std::size_t>(tables_.unit_list.regions.RegionOf(unit));
      out.au[side][unit] = std::as_const(now[side][of].au)[side][unit];
    }
  }
  // Residuals belong to the whole face; they and both eyes move together, whichever side begins.
  out.residuals = now.left[static_cast<std::size_t>(Region::kMouth)].residuals;
  out.gaze = now.left[static_cast<std::size_t>(Region::kEye)].gaze;
  for (std::size_t i = 0; i < emotions_.size(); ++i) {
    const float weight = emotions_[i].At(t);
    if (weight == 0) continue;
    layers.AddSignal(SignalName::kExpression, std::min(1.0f, weight));
    const auto found = expressions_.find(tables_.unit_list.face_slots[i].emotion);
    if (found == expressions_.end()) continue;
    AddTo(layers.Layer(LayerName::kEmotions).look, found->second.LookOf(1, weight), 1);
  }
}

void ExpressionMotion::ForEachTrack(const TrackVisitor& visit) const {
  for (const Side side : kSides) {
    for (const auto& region : regions_[side]) visit(region);
  }
  visit(shown_);
  for (const auto& emotion : emotions_) visit(emotion);
}

vm::Time ExpressionMotion::SettledAt(vm::Time t) const {
  vm::Time settled = std::max(t, onset_end_);
  for (const auto& emotion : emotions_) settled = std::max(settled, emotion.SettledAt(t));
  return settled;
}

}  // namespace fsm
