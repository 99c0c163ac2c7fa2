#include "hypermask/sim/sim_rig.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

namespace hypermask {
namespace {

vm::Time Micros(double ms) { return vm::Time(std::llround(1000 * ms)); }

}  // namespace

vm::Result<SimSettings> SimSettings::Parse(const std::string& text) {
  SimSettings settings;
  std::istringstream words(text);
  std::string word;
  words >> word;
  const auto kind = Movement::Named(word);
  if (!kind) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is no movement, expected one of: {}",
                                                     word, Movement::Names()));
  }
  settings.movement = *kind;
  while (words >> word) {
    const auto equals = word.find('=');
    const std::string key = word.substr(0, equals);
    double value = -1;
    const char* const begin =
        word.data() + (equals == std::string::npos ? word.size() : equals + 1);
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(begin, end, value);
    const bool number = error == std::errc() && stop == end && std::isfinite(value);
    if (key == "delay" && number && value >= 0 && value <= 1000) {
      settings.delay_ms = value;
    } else if (key == "seed" && number && value >= 0 && value <= 1e9) {
      settings.seed = static_cast<std::uint32_t>(value);
    } else if (key == "rate" && number && value >= 5 && value <= 120) {
      settings.rate = value;
    } else if (key == "cover" && number && value >= 0 && value <= 1000) {
      settings.cover_each_s = value;
    } else {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("found '{}', expected delay=0..1000, seed=N, rate=5..120 or "
                                  "cover=0..1000",
                                  word));
    }
  }
  return settings;
}

unsigned CoveredMarkers(const SimSettings& settings, double seconds) {
  if (settings.cover_each_s <= 0) return 0;
  constexpr double kCovered = 0.5;
  const double turn = seconds / settings.cover_each_s;
  if (seconds - std::floor(turn) * settings.cover_each_s < settings.cover_each_s - kCovered)
    return 0;
  return static_cast<long>(turn) % 2 == 0 ? 1u : ~0u;
}

SimRig::SimRig(vm::Scheduler& scheduler, const MaskLayout& layout, const SimSettings& settings,
               Events events)
    : scheduler_(scheduler),
      settings_(settings),
      events_(std::move(events)),
      camera_(stage_),
      movement_(settings.movement, settings.seed),
      begun_(scheduler.Now()),
      camera_delay_(Micros(settings.delay_ms / 2)),
      projector_delay_(Micros(settings.delay_ms) - camera_delay_) {
  stage_.layout = layout;
  timer_ = scheduler_.At(begun_, [this] { Expose(); });
}

SimRig::~SimRig() {
  scheduler_.Cancel(timer_);
  for (const auto& [timer, picture] : arriving_) scheduler_.Cancel(timer);
}

double SimRig::SecondsAt(vm::Time time) const {
  return static_cast<double>((time - begun_).count()) / 1e6;
}

vm::Result<void> SimRig::Show(const fsm::Image& frame) {
  if (shown_.size() == kMostFrames) shown_.pop_front();
  shown_.push_back({scheduler_.Now() + projector_delay_, frame});
  // Of those that are lit already only the last one counts.
  while (shown_.size() > 1 && shown_[1].from <= scheduler_.Now()) shown_.pop_front();
  return {};
}

std::optional<double> SimRig::Miss(const PlaneMap& map, double shown_s) const {
  const double lit = SecondsAt(scheduler_.Now() + projector_delay_);
  double sum = 0, count = 0;
  for (const double part : {0.0, 0.5, 1.0}) {
    for (const double miss : LandingDistances(stage_, map, movement_.At(lit + part * shown_s))) {
      sum += miss * miss;
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

const fsm::Image* SimRig::Lit() {
  while (shown_.size() > 1 && shown_[1].from <= scheduler_.Now()) shown_.pop_front();
  return !shown_.empty() && shown_[0].from <= scheduler_.Now() ? &shown_[0].frame : nullptr;
}

void SimRig::Expose() {
  const double seconds = SecondsAt(scheduler_.Now());
  Grey picture;
  camera_.See(movement_.At(seconds - stage_.exposure_s / 2),
              movement_.At(seconds + stage_.exposure_s / 2), pictures_,
              CoveredMarkers(settings_, seconds), filter_off_ ? Lit() : nullptr, picture);
  const vm::TimerId arrives = scheduler_.After(camera_delay_, [this] {
    const Grey came = std::move(arriving_.front().second);
    arriving_.pop_front();
    events_.picture(came, scheduler_.Now());
  });
  arriving_.emplace_back(arrives, std::move(picture));
  ++pictures_;
  timer_ = scheduler_.At(begun_ + Micros(1000 * pictures_ / settings_.rate), [this] { Expose(); });
}

}  // namespace hypermask
