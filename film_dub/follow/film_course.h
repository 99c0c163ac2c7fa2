#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "face_fit/find/network/attention_points.h"
#include "face_fit/find/network/face_networks.h"
#include "face_track/follow/tracker.h"

namespace filmdub {

/// A head turned further than this from the camera is not painted over, degrees.
inline constexpr float kMostTurn = 25;
/// The longest film, pictures.
inline constexpr std::size_t kMostPictures = 60'000;

/// What every picture of a film shows, in order.
struct FilmCourse {
  int width = 0, height = 0;
  std::vector<facetrack::FaceLine> lines;  ///< without their points
  double grain = 0;                        ///< GrainBetween, the usual one

  std::vector<double> Times() const;  ///< of the pictures, ms
  /// Whether the face of a picture can be painted over: there is one, it is seen well and not
  /// turned away.
  bool IsUsable(std::size_t picture) const;
  /// The picture to make a head of: the face turned to the camera, its mouth and eyes as at rest;
  /// none where no picture is usable.
  std::optional<std::size_t> RestPicture() const;
  /// How a head is turned in a picture that is so `held` in another one: as much further as the
  /// film's head has turned between them.
  fsm::Angles Turned(const fsm::Angles& held, std::size_t from, std::size_t picture) const;
};

/// Follows the face through a film. `told` is called after each picture with its time. Errors: the
/// film's, kBadValue (fewer than two pictures, or no face in any), kLimit.
vm::Result<FilmCourse> Survey(const std::string& film, facefit::FaceNetworks& networks,
                              facefit::AttentionNetwork& attention,
                              const facetrack::Tracker::Settings& settings,
                              const std::function<void(std::size_t pictures, double ms)>& told);

/// "0.40 to 1.20 s, 3.00 s": the times of pictures for which `is` holds.
std::string Stretches(const FilmCourse& course, const std::function<bool(std::size_t)>& is);

}  // namespace filmdub
