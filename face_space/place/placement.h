#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "face_space/eigen/head_motion.h"
#include "fsm/rig/head.h"
#include "vm_protocol/core/result.h"

namespace facespace {

/// Where on a built-in head a marker lies: its name and the place, mm at rest.
using KnownPlaces = std::map<std::string, glm::vec3, std::less<>>;

/// Reads a table of lines `place MARKER LANDMARK` (a name that fsm --describe prints) or `place
/// MARKER X Y Z` on that head. Errors: kBadValue "NAME:LINE: ...".
vm::Result<KnownPlaces> ReadPlaces(const std::string& name, std::string_view text,
                                   const fsm::Head& head);
/// What is known without such a table: markers called as the head's landmarks, whatever their case,
/// and of face_track's points (0, 1, ...) those of face_space/tables/network_points.txt.
KnownPlaces PlacesByName(const std::vector<std::string>& markers, const fsm::Head& head);

/// Markers on a head, and how their frame becomes the head's.
struct Placement {
  std::vector<std::uint32_t> vertices;  ///< of each marker the skin's vertex nearest to it
  std::vector<double> misses_mm;        ///< how far that is from it
  Eigen::Matrix3d turn;                 ///< of moves, into the head's frame
  double scale = 1;  ///< of moves, likewise: as large as the head is beside the face

  /// Moves of markers (3 numbers each) in the head's frame and size.
  Eigen::VectorXd OnHead(const Eigen::Ref<const Eigen::VectorXd>& moves) const;
};

/// Brings the markers of a face onto a head: turned, scaled and shifted so that the known ones come
/// nearest to their places, then bent so that they come to lie there, the others between them by
/// radial basis functions, as the papers do. REQUIRES: a built-in head. Errors: kBadValue for fewer
/// than 4 known places or known places on a line.
vm::Result<Placement> PlaceMarkers(const FaceAtRest& rest, const KnownPlaces& known,
                                   const fsm::Head& head);

/// Vertices of a head's skin and lips that markers may stand on: those of the face, not the mouth's
/// inside, ears or neck.
std::vector<std::uint32_t> FaceSkin(const fsm::Head& head);

}  // namespace facespace
