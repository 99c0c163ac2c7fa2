#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "face_fit/find/network/face_networks.h"
#include "face_track/fit/person.h"
#include "face_track/follow/face_line.h"
#include "face_track/follow/smooth.h"

namespace facetrack {

/// Follows the largest face from picture to picture: the first second of each person is taken for
/// its rest, so lines of it come when it is over. A face that is lost is looked for in each third
/// picture, at once after a cut; whoever is found there is somebody else where the face known so
/// far does not fit. Times rise. Not for several threads.
/// Limits: kMostWaiting pictures wait for a person to be met.
class Tracker {
 public:
  struct Settings {
    float field_degrees = 40;  ///< that the camera sees from below to above
    double settle_ms = 1000;   ///< taken for a person's rest
    float smooth = 1;          ///< 0 = not at all; 2 = twice as much
  };
  static constexpr std::size_t kMostWaiting = 240;

  /// All outlive it.
  Tracker(facefit::FaceNetworks& networks, facefit::Network& attention, const SeenFace& face,
          const Settings& settings);

  /// The lines that are known now: of this picture, of several, or none yet.
  std::vector<FaceLine> Look(const fsm::Image& picture, double ms);
  /// The lines that still wait: the person is met by what was seen so far.
  std::vector<FaceLine> Finish();
  /// Takes this for whoever is seen first, in place of the first second.
  void Know(Person person) { person_ = std::move(person), people_ = 1; }

 private:
  struct Waiting {
    double ms;
    float certainty = 0;
    std::optional<Sighting> seen;
    std::optional<Doing> doing;  // of a person that was met
  };
  bool IsCut(const fsm::Image& picture);
  std::optional<Waiting> See(const fsm::Image& picture, double ms, bool cut);
  std::optional<facefit::AttentiveFace> Find(const fsm::Image& picture);
  FaceLine LineOf(const Waiting& waiting);
  void SmoothLine(FaceLine& line);

  facefit::FaceNetworks& networks_;
  facefit::Network& attention_;
  const SeenFace& face_;
  const Settings settings_;
  std::optional<FrameFit> fit_;  // once a picture's size is known
  std::optional<Person> person_;
  int people_ = 0;
  std::optional<Doing> last_;  // none where no face is followed
  int unseen_ = 0;             // pictures since it was lost
  std::deque<Waiting> waiting_;
  std::vector<float> thumbnail_;
  std::vector<Smooth> filters_;
  double last_ms_ = 0;
};

}  // namespace facetrack
