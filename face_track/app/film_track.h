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
  std::string lesson;  ///< a table of when units are shown; "" = the track is printed
  std::string person;  ///< a table of how this person's face moves; "" = as faces usually do
  Tracker::Settings tracker{};
};

/// Returns the face to follow: the usual one, or that person's. Throws std::runtime_error.
SeenFace FaceToFollow(const std::string& person);

/// Follows the face through the film, and prints its track or, with a lesson, the table of how it
/// moves. Lines found before an error stay printed. Throws std::runtime_error with a sentence:
/// networks, film or file fail, or there is no face.
void PrintFilmTrack(const FilmTrack& wanted);

}  // namespace facetrack
