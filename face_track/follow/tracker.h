#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "face_fit/find/network/attention_points.h"
#include "face_fit/find/network/face_networks.h"
#include "face_track/fit/image_fit.h"
#include "face_track/fit/person.h"
#include "face_track/follow/cut_finder.h"
#include "face_track/follow/face_line.h"
#include "face_track/follow/noise_filter.h"
#include "face_track/follow/smooth.h"

namespace facetrack {

/// Follows one face from picture to picture: the first second of each person is taken for its rest,
/// so lines of it come when it is over. A face that is lost is looked for in each third picture, at
/// once after a cut, and among several the one that looks like the person met before is taken;
/// where none does, another person is met. Times rise. Not for several threads.
/// Limits: kMostWaiting pictures wait for a person to be met.
class Tracker {
 public:
  struct Settings {
    float field_degrees = 40;  ///< that the camera sees from below to above
    double settle_ms = 1000;   ///< taken for a person's rest
    float smooth = 1;          ///< 0 = not at all; 2 = twice as much
    std::size_t which = 1;     ///< of several faces: 1 = the largest
    bool careful = false;      ///< the network looks thrice at each picture
  };
  static constexpr std::size_t kMostWaiting = 120;

  /// All outlive it.
  Tracker(facefit::FaceNetworks& networks, facefit::AttentionNetwork& attention,
          const SeenFace& face, const Settings& settings);

  /// The lines that are known now: of this picture, of several, or none yet.
  std::vector<FaceLine> Look(const fsm::Image& picture, double ms);
  /// The lines that still wait: the person is met by what was seen so far.
  std::vector<FaceLine> Finish();

 private:
  struct Waiting {
    double ms;
    float certainty = 0;
    Sighting seen;
    FaceLook look;
    Doing doing;
  };
  struct Candidate {
    facefit::AttentiveFace face;
    Doing doing;
  };
  std::optional<Waiting> See(const fsm::Image& picture, double ms, bool cut);
  /// What the network sees of a face when it is shown it as it was when the table was made; none
  /// where that is no face.
  std::optional<Candidate> LookAt(const fsm::Image& picture, facefit::AttentiveFace found,
                                  const Doing* start, const Points& rest, FrameFit::What what);
  /// The mean of what the network sees in a face's crop and in two that are shifted, scaled and
  /// turned a little to either side.
  facefit::AttentiveFace LookAround(const fsm::Image& picture, const facefit::AttentiveFace& found);
  /// The face to follow from now on, where none was: the person that was met, else another one.
  /// After a cut it has to look like that person.
  std::optional<Candidate> Find(const fsm::Image& picture, bool cut);
  /// What a person that was met does, by points and picture.
  Doing Follow(const Sighting& seen, const FaceLook& look, const Doing& start);
  void Forget();
  FaceLine LineOf(const Waiting& waiting, const Doing& doing);
  void SmoothLine(FaceLine& line);

  facefit::FaceNetworks& networks_;
  facefit::AttentionNetwork& attention_;
  const SeenFace& face_;
  const Settings settings_;
  std::optional<FrameFit> fit_;  // once a picture's size is known
  std::optional<Person> person_;
  std::optional<ImageFit> image_fit_;  // of that person
  int people_ = 0;
  std::optional<Doing> last_;  // none where no face is followed
  int unseen_ = 0;             // pictures since it was lost
  int unlike_ = 0;             // pictures in which a face is followed that is not the person's
  std::deque<Waiting> waiting_;
  CutFinder cut_finder_;
  NoiseFilter noise_filter_;
  std::vector<Smooth> filters_;
  double last_ms_ = 0;
};

}  // namespace facetrack
