#pragma once

#include <string>
#include <vector>

#include "hypermask/follow/predictor.h"
#include "hypermask/project/calibration.h"
#include "hypermask/sim/sim_rig.h"

namespace hypermask {

/// Calibrates the simulated stage by the same pattern and sums as real devices: the mask held still
/// in `places` places. `camera_field`: degrees that the user believes the camera to see from below
/// to above. Errors as Calibrate and ReadPlace.
vm::Result<Calibration> CalibrateStage(const Stage& stage, std::size_t places, double camera_field);

/// How far the face lands from where it should, pixels of the projector: at five points of the
/// oval, at the beginning, the middle and the end of the time each frame is shown.
struct LandingError {
  double rms = 0, p95 = 0, most = 0;
};

/// What is to be measured.
struct TrialWish {
  Prediction prediction = Prediction::kBank;
  Form form = Form::kSpace;
  double delay_ms = 100;
};
struct TrialResult {
  TrialWish wish{};
  LandingError error{};
};

/// Lets the mask move for `seconds`, follows it in the camera's pictures, and says for each wish
/// where its face would have landed. The first second does not count.
std::vector<TrialResult> RunTrial(const Stage& stage, const Calibration& calibration,
                                  const SimSettings& settings, double seconds,
                                  const std::vector<TrialWish>& wishes);

/// The table of docs/hypermask.md, in Markdown: movements, delays and predictions by one form each.
std::string ErrorTable(std::uint32_t seed, double seconds, double camera_field);

}  // namespace hypermask
