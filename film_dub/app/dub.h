#pragma once

#include <string>

#include "face_track/follow/tracker.h"
#include "film_dub/speech/new_speech.h"

namespace filmdub {

/// What is to become of which film.
struct Dub {
  std::string film;
  SpeechWanted speech;
  std::string out;       ///< a name FilmWriter takes
  std::string networks;  ///< as FaceNetworks::Load takes it
  facetrack::Tracker::Settings tracker{};
  bool quiet = false;
};

/// What the new film's metadata says of it.
inline constexpr const char* kAltered =
    "Altered: what is said, and mouth and chin of the person, were made by Galatea film_dub.";

/// Follows the face through the film, makes a head of it, and writes the film anew with the words
/// and the mouth that says them. Tells on standard error how far it is and which pictures are as
/// they were. Throws std::exception with a sentence; then there is no new film.
void MakeDub(const Dub& wanted);

}  // namespace filmdub
