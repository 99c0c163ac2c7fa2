#pragma once

#include <string>
#include <vector>

#include "hypermask/sim/sim_rig.h"

namespace hypermask {

/// The demonstration: the stage as the audience sees it, left without and right with prediction.
struct StageFilm {
  std::string face{};   ///< the face's picture or film, as facetrack::OpenPictures takes it; a film
                        ///< begins anew where it ends
  std::string sound{};  ///< a .wav; "" = silent
  std::string out{};    ///< as fsm::FilmWriter::Open
  std::vector<SimSettings> scenes{};  ///< one after the other
  double scene_seconds = 6;
};

/// 1280 x 720, 30 pictures a second. The stage is calibrated as a real one would be. Throws
/// std::runtime_error with a sentence: no face, no encoder.
void MakeStageFilm(const StageFilm& wanted);

}  // namespace hypermask
