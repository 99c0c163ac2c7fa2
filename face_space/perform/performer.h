#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "face_space/eigen/eigen_units.h"
#include "face_space/place/placement.h"
#include "face_space/record/recording.h"
#include "face_space/record/unit_track.h"
#include "fsm/rig/head.h"

namespace facespace {

/// Vertices of a built-in head's face that stand for markers: spread over it, closer about nose and
/// mouth, and on the edges of the lids, where no marker of a person could be. The same head gives
/// the same ones.
struct HeadSites {
  std::vector<std::uint32_t> vertices;
  std::vector<std::string> names;  ///< s001, s002, ...
  KnownPlaces places;
};
inline constexpr std::size_t kPaperMarkers = 146;
HeadSites SitesOf(const fsm::Head& head, std::size_t count = kPaperMarkers);

/// The places of the sites in a state, 3 numbers each, mm.
Eigen::VectorXd SitesIn(const fsm::Head& head, const HeadSites& sites, const fsm::FaceState& state);

/// The sites of a head that does what a track of units says.
Recording RecordingOf(const UnitTrack& track, const fsm::Head& head, const HeadSites& sites);

/// How a head performs.
struct Performer {
  double rate = 120;                      ///< frames a second
  int times = 1;                          ///< how often each expression, from rest and back
  double noise_mm = 0.15;                 ///< deviation of each coordinate of a marker
  double head_degrees = 6, head_mm = 15;  ///< by which the head turns and moves meanwhile
  std::uint64_t seed = 1;
};
/// A recording of a head that shows units together, each of which begins up to 60 ms later than the
/// first. The exact places of the head's rig, both sides alike, with the motion and noise asked
/// for. `name`: the recording's; others of the same settings have other noise.
Recording Perform(const Performer& settings, const fsm::Head& head, const HeadSites& sites,
                  const std::string& name, const std::vector<Label>& units);
/// The state in which units, called by number, act on both sides.
fsm::FaceState StateOf(const std::vector<Label>& units);

/// The 11 units the demonstration shows; the papers do not say which theirs were.
std::vector<std::string> PaperUnits();
/// Mixtures of two to four of the units, drawn by chance, none twice, without units that the
/// head's table lets act against each other (if `apart`). Every unit is in some.
std::vector<std::vector<Label>> Mixtures(const std::vector<std::string>& units, std::size_t count,
                                         const fsm::Head& head, bool apart, std::uint64_t seed);

}  // namespace facespace
