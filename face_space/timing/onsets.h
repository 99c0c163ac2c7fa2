#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "face_space/record/unit_track.h"
#include "fsm/motion/inputs/expression_table.h"

namespace facespace {

/// One number for each part of the face, by fsm::Region: eyes, brows, mouth.
template <typename T>
using ByRegion = std::array<T, fsm::kRegions>;

/// How far each part of the face is from rest over time: the root of the sum of squares of its
/// units' strengths, both sides counting half.
std::vector<ByRegion<double>> RegionCourses(const UnitTrack& track,
                                            const fsm::UnitRegions& regions);

/// How one expression of a track comes about, in the terms of Morishima and others, Dynamic Micro
/// Aspects of Facial Movements in Elicited and Posed Expressions Using High-Speed Camera, IEEE
/// RO-MAN 2001: what fsm's table emotions.txt has for each emotion.
struct Onset {
  double begins_ms = 0;                    ///< on the track's clock, where the first part begins
  double onset_ms = 0;                     ///< from there until the last part is at its peak
  ByRegion<std::optional<double>> lag_ms;  ///< after begins_ms; none of a part that hardly moves
  ByRegion<double> moved{};                ///< by how much, in strengths of units
};

/// The expressions of a track: rises of all parts together by kLeastRise or more. A part begins and
/// ends where the minimum-jerk curve (fsm::SmootherStep) does that lies nearest to its course
/// between a fifth and four fifths of its way, so that noise at rest and at the peak counts little.
std::vector<Onset> FindOnsets(const UnitTrack& track, const fsm::UnitRegions& regions);
inline constexpr double kLeastRise = 0.3;

/// The median of several onsets; a part's lag counts where it moves in more than half of them, and
/// the least lag is zero. REQUIRES: one or more.
Onset MedianOnset(const std::vector<Onset>& onsets);

/// The table emotions.txt with another timing: `kind` is posed or elicited. Parts without a lag
/// keep the one they had. Error: kBadValue if the table has no such row.
vm::Result<std::string> WithTiming(const std::string& table, const std::string& kind,
                                   const std::string& emotion, const Onset& onset);

}  // namespace facespace
