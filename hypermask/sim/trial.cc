#include "hypermask/sim/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hypermask/calibrate/calibrator.h"
#include "hypermask/find/marker_finder.h"
#include "hypermask/follow/mask_follower.h"
#include "vm_protocol/core/or_throw.h"

namespace hypermask {

vm::Result<Calibration> CalibrateStage(const Stage& stage, std::size_t places,
                                       double camera_field) {
  const StageCamera camera(stage);
  const Movement movement(Movement::Kind::kPlaces, 1);
  const MarkerFinder finder(stage.layout);
  const Pinhole& lens = stage.camera.lens;
  const Pinhole& projector = stage.projector.lens;
  const DotPattern pattern(projector.width, projector.height);
  std::vector<Place> taken;
  std::uint32_t number = 0;
  Grey picture;
  for (std::size_t i = 0; i < places; ++i) {
    const Pose pose = movement.At((static_cast<double>(i) + 0.5) * Movement::kHoldSeconds);
    PlaceTaker taker(pattern, 0);
    while (const auto frame = taker.Begin(0)) {
      do {
        camera.See(pose, pose, number++, 0, &*frame, picture);
      } while (!taker.Take(picture, 0));
    }
    auto place = ReadPlace(pattern, taker.pictures(), finder);
    if (!place) return std::unexpected(place.error());
    taken.push_back(std::move(*place));
  }
  return Calibrate(taken, stage.layout, Pinhole::OfField(lens.width, lens.height, camera_field),
                   projector.width, projector.height);
}

std::vector<TrialResult> RunTrial(const Stage& stage, const Calibration& calibration,
                                  const SimSettings& settings, double seconds,
                                  const std::vector<TrialWish>& wishes) {
  const StageCamera camera(stage);
  const Movement movement(settings.movement, settings.seed);
  const double shown_for = 1 / settings.rate;
  MaskFollower follower(stage.layout, {.prediction = Prediction::kOff, .ahead = 0});
  // Wishes that differ in nothing but their form share a predictor.
  struct Run {
    TrialWish wish;
    Predictor predictor;
    std::vector<double> misses{};
  };
  std::vector<Run> runs;
  for (const TrialWish& wish : wishes) {
    runs.push_back({wish, Predictor(wish.prediction, wish.delay_ms / 1000 + shown_for / 2)});
  }
  Grey picture;
  const auto pictures = static_cast<std::uint32_t>(seconds * settings.rate);
  for (std::uint32_t number = 0; number < pictures; ++number) {
    const double now = number * shown_for;
    camera.See(movement.At(now - stage.exposure_s / 2), movement.At(now + stage.exposure_s / 2),
               number, CoveredMarkers(settings, now), nullptr, picture);
    if (follower.Look(picture, now) == 0) continue;
    for (Run& run : runs) {
      run.predictor.Measure(now, follower.markers());
      if (now < 1) continue;
      const double lit = now + run.wish.delay_ms / 1000;
      const auto map = MaskToProjector(calibration, run.wish.form, stage.layout,
                                       run.predictor.At(lit + shown_for / 2));
      if (!map) continue;
      for (const double part : {0.0, 0.5, 1.0}) {
        const auto distances = LandingDistances(stage, *map, movement.At(lit + part * shown_for));
        run.misses.insert(run.misses.end(), distances.begin(), distances.end());
      }
    }
  }
  std::vector<TrialResult> results;
  for (Run& run : runs) {
    TrialResult result{.wish = run.wish};
    std::ranges::sort(run.misses);
    double sum = 0;
    for (const double miss : run.misses) sum += miss * miss;
    if (!run.misses.empty()) {
      const auto count = run.misses.size();
      result.error = {std::sqrt(sum / static_cast<double>(count)), run.misses[count * 95 / 100],
                      run.misses.back()};
    }
    results.push_back(result);
  }
  return results;
}

std::string ErrorTable(std::uint32_t seed, double seconds, double camera_field) {
  const Stage stage;
  const Calibration calibration = vm::OrThrow(CalibrateStage(stage, 6, camera_field));
  std::string table = fmt::format(
      "Calibrated in 6 places: homography {:.2f}, affine {:.2f}, space {:.2f} pixels rms.\n\n"
      "| movement | form | delay ms | without | single | bank | bank p95 | bank most |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
      calibration.homography_rms, calibration.affine_rms, calibration.space_rms);
  const std::pair<Form, const char*> forms[] = {
      {Form::kSpace, "SPACE"}, {Form::kHomography, "HOMOGRAPHY"}, {Form::kAffine, "AFFINE"}};
  const Prediction predictions[] = {Prediction::kOff, Prediction::kSingle, Prediction::kBank};
  for (const auto kind : {Movement::Kind::kSway, Movement::Kind::kWalk, Movement::Kind::kShake,
                          Movement::Kind::kTurn}) {
    std::vector<TrialWish> wishes;
    for (const auto& [form, name] : forms) {
      for (const double delay : {0.0, 50.0, 100.0, 150.0}) {
        for (const Prediction prediction : predictions) wishes.push_back({prediction, form, delay});
      }
    }
    const auto results =
        RunTrial(stage, calibration, {.movement = kind, .seed = seed}, seconds, wishes);
    for (std::size_t i = 0; i + 2 < results.size(); i += 3) {
      const auto name =
          std::ranges::find(forms, results[i].wish.form, &std::pair<Form, const char*>::first);
      table += fmt::format("| {} | {} | {:g} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n",
                           Movement::NameOf(kind), name->second, results[i].wish.delay_ms,
                           results[i].error.rms, results[i + 1].error.rms, results[i + 2].error.rms,
                           results[i + 2].error.p95, results[i + 2].error.most);
    }
  }
  return table;
}

}  // namespace hypermask
