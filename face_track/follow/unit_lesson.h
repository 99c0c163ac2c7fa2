#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "face_track/follow/face_line.h"
#include "face_track/model/shown_units.h"

namespace facetrack {

/// Learns how one person's face moves from a film in which the person shows one unit after the
/// other, by a table of when: rows `show FROM TO UNIT [DOSE]`, seconds in the film and how strongly
/// (1: as strongly as that person can). Of each time the half of the pictures counts in which the
/// points moved most the way they usually do, so that nobody needs to be exact. A unit that is
/// hardly shown, or without a face, is left as it usually is. Limits: kMostPrompts rows, kMostMs
/// each, kMostPictures of each. Not for several threads.
class UnitLesson {
 public:
  static constexpr std::size_t kMostPrompts = 100, kMostPictures = 600;
  static constexpr double kMostMs = 10'000;

  /// `face` outlives it. Errors: kBadValue "NAME:LINE: ..." for units that the face does not have
  /// or that come twice, and times that do not rise.
  static vm::Result<UnitLesson> Parse(const std::string& name, std::string_view prompts,
                                      const SeenFace& face);

  /// The next line of the film's track.
  void Add(const FaceLine& line);

  struct Learned {
    std::vector<ShownUnit> shown;
    std::vector<std::string> left_out;  ///< a sentence for each unit that was not shown
  };
  /// What the lines so far tell. Errors: kBadValue where there is no face before the first time, or
  /// another person's after it.
  vm::Result<Learned> Finish();

 private:
  struct Prompt {
    double from_ms, to_ms;
    int unit;
    float dose;
    std::string place;  ///< "NAME: unit 12 from 3 s to 5 s", for errors
  };
  UnitLesson(const SeenFace& face, std::vector<Prompt> prompts)
      : face_(&face), prompts_(std::move(prompts)) {}
  /// Ends what is shown now, or the rest before the first.
  void Close();

  const SeenFace* face_;
  std::vector<Prompt> prompts_;
  std::size_t next_ = 0;          // of prompts_: shown now or next
  std::vector<Points> pictures_;  // since it began, or of the rest
  int person_ = 0;                // the first one
  Points rest_;
  Learned learned_;
  vm::Result<void> so_far_{};  // an error ends the lesson
};

}  // namespace facetrack
