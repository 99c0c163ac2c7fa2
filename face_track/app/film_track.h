#pragma once

#include <string>

#include "face_track/follow/tracker.h"
#include "face_track/print/face_print.h"

namespace facetrack {

/// What is to be printed of which film.
struct FilmTrack {
  std::string film;      ///< as OpenPictures takes it
  std::string out;       ///< where the lines go; "" = standard output
  std::string plot;      ///< an SVG file; "" = none
  std::string networks;  ///< as FaceNetworks::Load takes it
  double rate = 25;      ///< pictures a second of a folder
  FacePrint::Format format = FacePrint::Format::kCsv;
  FacePrint::Extras extras{};
  bool quiet = false;
  Tracker::Settings tracker{};
};

/// Follows the face through the film. Lines found before an error stay printed. Throws
/// std::runtime_error with a sentence: networks, film or file fail, or there is no face.
void PrintFilmTrack(const FilmTrack& wanted);

}  // namespace facetrack
