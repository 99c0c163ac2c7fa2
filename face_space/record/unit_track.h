#pragma once

#include <string>
#include <vector>

#include "face_space/record/track.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "vm_protocol/core/result.h"

namespace facespace {

/// What a face does over time, as units.
struct UnitTrack {
  std::string name;
  std::vector<double> ms;
  std::vector<fsm::FaceLook> looks;  ///< one a frame
};

/// Whether the columns of a track are units (au12L, au26) or ARKit's shapes (jawOpen, also written
/// JawOpen).
bool HasUnits(const Track& track, const fsm::MotionTables& tables);
/// The units of a track. ARKit's shapes become units by fsm's table arkit.txt. Strengths are held
/// within 0 and 2; columns that are neither are left out. Error: kBadValue naming the recording if
/// there are none.
vm::Result<UnitTrack> UnitsOf(const Track& track, const fsm::MotionTables& tables);

}  // namespace facespace
