#pragma once

#include "fsm/head/anatomy.h"
#include "fsm/head/cage.h"

namespace fsm {

/// Add the curves eye0..eye5 and mouth0..mouth9.
void AddLidCurves(const EyeAnatomy& eye, Cage& cage);
void AddMouthCurves(const MouthAnatomy& mouth, Cage& cage);

}  // namespace fsm
